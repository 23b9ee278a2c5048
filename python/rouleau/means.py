"""Means of noisy numbers."""

from __future__ import annotations

import math
from typing import NamedTuple, Sequence


class SeedMean(NamedTuple):
    """The mean of runs that differ by their seed."""

    value: float  #: mean of the runs, each counting the same
    error: float  #: standard error of the mean: the larger of the next two
    between: float  #: standard error from the spread of the runs; nan of one run
    within: float  #: standard error from the errors of the runs; nan where one of them is not known
    bar95: float  #: half of the interval that holds the true mean in 95 % of cases; nan of one run


def mean_of_seeds(values: Sequence[float], errors: Sequence[float]) -> SeedMean:
    """The mean over runs of different seeds. The spread of the runs holds what changes from seed to seed and, as its least
    part, what each run does not know of its own mean: by chance it may come out below that, and then the latter stands."""
    count = len(values)
    if count == 0:
        return SeedMean(*[math.nan] * 5)
    mean = math.fsum(values) / count
    between = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (count - 1) / count) if count > 1 else math.nan
    within = math.sqrt(math.fsum(error ** 2 for error in errors)) / count
    known = [error for error in (between, within) if math.isfinite(error)]
    error = max(known) if known else math.nan
    return SeedMean(mean, error, between, within, student_95(count - 1) * error)


def student_95(freedom: int) -> float:
    """How many standard errors the bar of 95 % has on each side where the error comes from `freedom` + 1 numbers: Student's t
    at 0.975, from the finite sums of Abramowitz and Stegun, 26.7.3 and 26.7.4, by bisection. nan for less than one."""
    if freedom < 1:
        return math.nan
    if freedom > 1000:
        return 1.959964 + 2.3722 / freedom  # the first term of Fisher's expansion: to 2e-6

    def inside(t: float) -> float:  # probability between -t and t
        angle = math.atan2(t, math.sqrt(freedom))
        sine, cosine = math.sin(angle), math.cos(angle)
        odd = freedom % 2
        term, total = (cosine if odd else 1.0), 0.0
        for k in range(3 if odd else 2, freedom + 1, 2):  # cos + 2/3 cos^3 + ..., or 1 + 1/2 cos^2 + ...
            total += term
            term *= cosine * cosine * (k - 1) / k
        return (angle + sine * total) * 2 / math.pi if odd else sine * total

    low, high = 1.0, 13.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if inside(middle) < 0.95 else (low, middle)
    return (low + high) / 2
