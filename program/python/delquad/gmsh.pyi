# SPDX-License-Identifier: GPL-3.0-or-later
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import Mesh, Result

def mesh(
    size: float | str | Callable[[npt.NDArray[np.float64]], npt.ArrayLike] | tuple[Mesh, npt.ArrayLike] | None = None,
    **settings: Any,
) -> Result: ...
