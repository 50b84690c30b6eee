"""What is measured of a scene."""
