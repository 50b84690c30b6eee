"""Flow curves of materials, and closed forms of laboratory tests."""
