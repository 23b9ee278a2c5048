"""A Gaussian process: what a few noisy computed values say about a smooth function between them."""

from __future__ import annotations

import math
from typing import Any

LENGTHS = (0.1, 0.15, 0.22, 0.33, 0.5, 0.75, 1.1, 1.7, 2.5)  # of the cube's side
SIZES = (0.03, 0.1, 0.3, 1.0, 3.0)  # of the function's bends, in standard deviations of the values
ROUGHNESSES = (1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0)  # of values beside their known errors
TREND = 10.0  # prior standard deviation of a constant and of slopes


class Process:
    """A function on the unit cube: a constant, slopes, and bends with a Matern kernel of order 5/2. Lengths, sizes and the
    roughness of the values beside their known errors are those of the greatest likelihood."""

    def __init__(self, u: Any, y: Any, errors: Any, settings: list[float] | None = None) -> None:
        """u [n, d] in the unit cube, y [n], errors [n] (0 where they are unknown); at least two values."""
        import numpy
        self._u, self._y, self._errors = numpy.asarray(u, float), numpy.asarray(y, float), numpy.asarray(errors, float)
        self._centre, self._scale = float(self._y.mean()), float(self._y.std()) or 1.0
        self.settings = settings or self._likeliest()
        self._factor, self._weights, _ = self._solved(self.settings)

    def _kernel(self, a: Any, b: Any, settings: list[float]) -> Any:
        import numpy
        axes = self._u.shape[1]
        between = (a[:, None, :] - b[None, :, :]) / numpy.array(settings[:axes])
        r = math.sqrt(5.0) * numpy.sqrt((between ** 2).sum(axis=2))
        return settings[axes] ** 2 * (1 + r + r ** 2 / 3) * numpy.exp(-r) + TREND ** 2 * (1 + (a - 0.5) @ (b - 0.5).T)

    def _solved(self, settings: list[float]) -> tuple[Any, Any, float]:
        import numpy
        noise = (self._errors / self._scale) ** 2 + settings[-1] ** 2
        factor = numpy.linalg.cholesky(self._kernel(self._u, self._u, settings) + numpy.diag(noise))
        whitened = numpy.linalg.solve(factor, (self._y - self._centre) / self._scale)
        # Beside the likelihood of the values, settings in the middle are a little more likely.
        prior = sum(math.log(length / 0.7) ** 2 for length in settings[:-2]) / 2 + (math.log(settings[-1] / 0.01) / 3) ** 2 / 2
        likelihood = -0.5 * float(whitened @ whitened) - float(numpy.log(numpy.diag(factor)).sum()) - prior
        return factor, numpy.linalg.solve(factor.T, whitened), likelihood

    def _likeliest(self) -> list[float]:
        axes = self._u.shape[1]
        choices = [LENGTHS] * axes + [SIZES, ROUGHNESSES]
        best: tuple[float, list[float]] = (-math.inf, [])
        for start in ([0.5] * axes + [1.0, 0.01], [1.7] * axes + [0.3, 0.1], [0.15] * axes + [1.0, 0.003]):
            now, reached = list(start), -math.inf
            while True:
                before = reached
                for k, values in enumerate(choices):
                    tried = [(self._solved([*now[:k], value, *now[k + 1:]])[2], value) for value in values]
                    reached, now[k] = max(tried)
                if reached <= before + 1e-9:
                    break
            best = max(best, (reached, now))
        return best[1]

    def at(self, places: Any) -> tuple[Any, Any]:
        """Mean and standard deviation [m] of the function at places [m, d]."""
        import numpy
        between = self._kernel(numpy.asarray(places, float), self._u, self.settings)
        own = self.settings[self._u.shape[1]] ** 2 + TREND ** 2 * (1 + ((places - 0.5) ** 2).sum(axis=1))
        spread = own - (numpy.linalg.solve(self._factor, between.T) ** 2).sum(axis=0)
        return self._centre + self._scale * between @ self._weights, self._scale * numpy.sqrt(numpy.maximum(spread, 0.0))

    def believing(self, place: Any) -> Process:
        """The same as if the mean had been computed at a place."""
        import numpy
        mean = self.at(place[None, :])[0]
        made = Process.__new__(Process)
        made._u, made._y = numpy.vstack([self._u, place]), numpy.append(self._y, mean)
        made._errors = numpy.append(self._errors, 0.0)
        made._centre, made._scale, made.settings = self._centre, self._scale, self.settings
        made._factor, made._weights, _ = made._solved(made.settings)
        return made
