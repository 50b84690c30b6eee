"""Diagnostics: quantities measured in a scene."""
