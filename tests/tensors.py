"""Symmetric tensors and velocity gradients for tests of kernels."""


def symmetric(six):
    """(n, 6) in the order xx, yy, zz, yz, xz, xy to (n, 3, 3)."""
    return six[:, [0, 5, 4, 5, 1, 3, 4, 3, 2]].reshape(-1, 3, 3)


def random_gradients(rng, n, size=1.0):
    return rng.normal(size=(n, 3, 3)) * size


# --- Particles, nodes and the tables between them -----------------------------------------------------------
