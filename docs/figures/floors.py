"""A floor as it is customarily made, to compare with: no choice of mpmkit, put in from outside."""

import mpmkit


def hold_floor(simulation: mpmkit.Simulation) -> None:
    """Set the vertical velocity of the nodes on the floor and behind it to zero, whenever it is computed."""
    operations, window = simulation.operations, simulation.operations.window

    def held(original):
        def operation(*args, **kwargs):
            original(*args, **kwargs)
            floor = window.walls[1, 0]
            nodes = window.nodes.reshape(*window.shape[:2], -1)
            nodes[:, max(floor - 1, 0) : floor + 1, [2, 4]] = 0.0

        return operation

    operations.map_to_grid = held(operations.map_to_grid)
    operations.solve_momentum = held(operations.solve_momentum)
