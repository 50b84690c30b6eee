"""Update orders."""
