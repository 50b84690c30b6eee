from dataclasses import dataclass
import numpy as np

@dataclass
class ContactNodes:
    position: np.ndarray
    normal: np.ndarray
    wall_velocity: np.ndarray
    mass: np.ndarray
    velocity: np.ndarray
    inner: np.ndarray
    depth: np.ndarray
    touched: np.ndarray
    memory: dict
