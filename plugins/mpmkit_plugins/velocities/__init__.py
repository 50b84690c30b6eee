"""Velocity updates."""
