"""The flow curve of a law: its stress in steady simple shear."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contracts import ElastoviscoplasticLaw, GeneralisedNewtonianLaw
from ..registry.audit import require_array, require_number


def flow_curve(law: Any, rates: np.ndarray) -> np.ndarray | None:
    """Stress, Pa, in simple shear at ``rates``, 1/s; None if the law has no flow curve."""
    if isinstance(law, GeneralisedNewtonianLaw):
        viscosity = law.apparent_viscosity(rates.copy())
        require_array(law, "apparent_viscosity", viscosity, rates.shape)
        return viscosity * rates
    if isinstance(law, ElastoviscoplasticLaw):
        stress = law.flow_curve(rates.copy())
        if np.ndim(stress) == 0:  # a constant is allowed
            return np.full(rates.shape, require_number(law, "flow_curve", stress))
        require_array(law, "flow_curve", stress, rates.shape)
        return stress
    return None
