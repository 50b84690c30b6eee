"""Compiled loops over particles and nodes. Each file holds one mapping; none of them knows a scheme."""

from .environment import require_sound_environment

require_sound_environment()
