"""Refinements."""
