"""Redistributions."""
