"""Compiled loops over particles and nodes. Each file holds one kind of loop; none depends on a scheme."""

from .environment import require_sound_environment

require_sound_environment()
