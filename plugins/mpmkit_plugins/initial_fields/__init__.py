"""Initial fields."""
