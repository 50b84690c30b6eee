"""Body shapes."""
