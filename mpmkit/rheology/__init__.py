"""Flow curves of materials, apart from any scene."""
