"""Volumetric treatments."""
