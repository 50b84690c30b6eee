"""``python -m mpmkit``."""

from .cli import main

main()
