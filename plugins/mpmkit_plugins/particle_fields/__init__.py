"""Fields of particles."""
