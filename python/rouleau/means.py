"""Means of noisy numbers."""

from __future__ import annotations

import math
from typing import NamedTuple, Sequence

from .errors import Error, Fault
from .scenes import floats


class SeedMean(NamedTuple):
    """The mean of runs that differ by their seed."""

    value: float  #: mean of the runs, each counting the same
    error: float  #: standard error of the mean: the larger of the next two
    between: float  #: standard error from the spread of the runs; nan of one run
    within: float  #: standard error from the errors of the runs; nan where one of them is not known
    bar95: float  #: half of the interval that holds the true mean in 95 % of cases; nan of one run


def mean_of_seeds(values: Sequence[float], errors: Sequence[float]) -> SeedMean:
    """The mean over runs of different seeds. The spread of the runs holds what changes from seed to seed and, as its least
    part, what each run does not know of its own mean. By chance it may come out below that, and then the latter stands.
    All is nan where there is no value, or one is nan. Throws Error where values and errors are not as many."""
    values, errors = _as_many("values", values, "errors", errors)
    count = len(values)
    if count == 0 or not all(map(math.isfinite, values)):
        return SeedMean(*[math.nan] * 5)
    mean = math.fsum(values) / count
    between = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (count - 1) / count) if count > 1 else math.nan
    within = math.sqrt(math.fsum(error ** 2 for error in errors)) / count
    known = [error for error in (between, within) if math.isfinite(error)]
    error = max(known) if known else math.nan
    return SeedMean(mean, error, between, within, student_95(count - 1) * error)


def _as_many(what: str, values: Sequence[float], beside: str, others: Sequence[float]) -> tuple[list[float], list[float]]:
    made = [floats(name, given, "give a list of numbers", lists=True).tolist() for name, given in ((what, values), (beside, others))]
    if len(made[0]) != len(made[1]):
        raise Error(Fault(f"there are {len(made[0])} {what} and {len(made[1])} {beside}", "give as many of both"))
    return made[0], made[1]


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


LEAST_VALUES = 20  # fewer are no series
MSER_GROUPS = 20  # groups of five values (MSER-5) from 100 values on, of fewer below
MSER_GROUP = 5
LEFT_OUT_MORE = 1.5  # times what MSER leaves out: the rest of a decay at its minimum biases the mean
LEAST_BATCHES = 10
MOST_CORRELATION = 0.4  # of neighbouring batches; what remains is corrected for
BATCH_GROWTH = 1.25
LEAST_PARTS = 15.0
MOST_RISE = 3.0  # standard errors of the rise of a straight line through the values


class Statistics(NamedTuple):
    """What a series in time says about its mean. Where it is not steady the mean, its error and `bar95` are nan."""

    value: float  #: mean of the values from `begin` on
    error: float  #: its standard error, which knows that values follow each other
    bar95: float  #: half of the interval that holds the true mean in 95 % of cases
    steady: bool  #: whether there is a mean
    verdict: str  #: "steady", or what is missing
    begin: float  #: when it became steady: in the unit of the times, else the index of a value; nan where it did not
    parts: float  #: number of independent parts: variance of the values over `error` squared; nan where it is unknown
    length: float  #: of an independent part, in the unit of the times, else in values
    batches: int  #: number of batches from which the error is; 0 where there is none

    def __str__(self) -> str:
        if not self.steady:
            return self.verdict
        return f"{self.value:.6g} +- {self.error:.2g} (95 %: +- {self.bar95:.2g}) from {self.begin:.4g} on, {self.parts:.0f} independent parts"


def statistics(values: Sequence[float], times: Sequence[float] | None = None) -> Statistics:
    """Where a series became steady, and its mean from there with a standard error, by one rule:

    1. The finite values at their times, which rise, are taken at as many equal distances in time (linear between them).
       Without times they are taken as they are.
    2. MSER-5: means of groups of five values (fewer where there are less than 100). So many of them are left out at the
       beginning that the estimated variance of the mean of the others is least. Half as many again are left out. Where
       that is more than half of all, the series is not steady.
    3. Batch means: the others are cut into batches of equal length, from one value on 1.25 times as long until neighbouring
       batches have a correlation below 0.4 (with its bias in short series taken off). The error is that of the mean of these
       batches times sqrt((1 + r) / (1 - r)) for the correlation r that remains. Fewer than ten batches: too short.
    4. Independent parts: the variance of the values over the square of the error. Fewer than 15: too short.
    5. A straight line through the values rises by more than three of its standard errors, which are those of step 3 for what
       the line leaves: not steady.

    `bar95` is Student's t for the smaller of the numbers of batches and of independent parts. Throws Error for what is no
    list of numbers, and where values and times are not as many.
    """
    y, first, distance = _equidistant(values, times)
    count = len(y)

    def without(verdict: str, parts: float = math.nan) -> Statistics:
        return Statistics(math.nan, math.nan, math.nan, False, verdict, math.nan, parts, math.nan, 0)

    if count < LEAST_VALUES:
        return without(f"too short: {count} values, and {LEAST_VALUES} are needed")
    left_out = _mser(y)
    if 2 * left_out > count:
        return without("not steady: it still changes in its second half")
    y = y[left_out:]
    begin = first + distance * left_out
    count = len(y)
    mean = math.fsum(y) / count
    variance = math.fsum((value - mean) ** 2 for value in y) / (count - 1)
    if variance <= (1e-14 * mean) ** 2:  # all values are the same
        return Statistics(mean, 0.0, 0.0, True, "steady", begin, float(count), distance, count)
    found = _error_from_batches(y)
    if found is None:
        return without("too short: values remember longer than a tenth of the series")
    error, batches = found
    parts = min(float(count), variance / error ** 2)
    if _rises(y, mean):
        return without("not steady: it rises or falls all the time", parts)
    if parts < LEAST_PARTS:
        return without(f"too short: {parts:.0f} independent parts, and {LEAST_PARTS:.0f} are needed", parts)
    bar = student_95(min(batches, int(parts)) - 1) * error
    return Statistics(mean, error, bar, True, "steady", begin, parts, distance * count / parts, batches)


def _equidistant(values: Sequence[float], times: Sequence[float] | None) -> tuple[list[float], float, float]:
    """Values at equal distances, as many as there are finite ones; the first place and the distance."""
    values, places = _as_many("values", values, "times", values if times is None else times)
    if times is None:
        return [value for value in values if math.isfinite(value)], 0.0, 1.0
    x: list[float] = []
    y: list[float] = []
    for place, value in zip(places, values):
        if math.isfinite(value) and (not x or place > x[-1]):
            x.append(place)
            y.append(value)
    if len(y) < 2:
        return y, x[0] if x else math.nan, math.nan
    distance = (x[-1] - x[0]) / (len(x) - 1)
    even = []
    k = 0
    for number in range(len(x)):
        place = x[0] + distance * number
        while k < len(x) - 2 and x[k + 1] < place:
            k += 1
        share = min(1.0, max(0.0, (place - x[k]) / (x[k + 1] - x[k])))
        even.append(y[k] + share * (y[k + 1] - y[k]))
    return even, x[0], distance


def _mser(y: Sequence[float]) -> int:
    """How many values are left out at the beginning."""
    group = min(MSER_GROUP, max(1, len(y) // MSER_GROUPS))
    count = len(y) // group
    odd = len(y) - count * group  # at the beginning, in no group
    means = [math.fsum(y[odd + k * group:odd + (k + 1) * group]) / group for k in range(count)]
    centre = math.fsum(means) / count  # sums of squares around it lose no digits
    total = squares = 0.0
    best, best_start = math.inf, 0
    for start in range(count - 1, -1, -1):
        offset = means[start] - centre
        total += offset
        squares += offset * offset
        size = count - start
        spread = max(0.0, squares - total * total / size) / size ** 2
        if size >= 5 and spread <= best:
            best, best_start = spread, start
    groups = math.ceil(LEFT_OUT_MORE * best_start)
    return odd + groups * group if groups else 0


def _rises(y: Sequence[float], mean: float) -> bool:
    """Whether a straight line through the values rises, or falls, by more than chance makes it."""
    count = len(y)
    middle = (count - 1) / 2
    slope = math.fsum((k - middle) * (value - mean) for k, value in enumerate(y)) * 12 / (count * (count * count - 1.0))
    found = _error_from_batches([value - mean - slope * (k - middle) for k, value in enumerate(y)])
    return found is not None and abs(slope) * count > MOST_RISE * math.sqrt(12.0) * found[0]


def _error_from_batches(y: Sequence[float]) -> tuple[float, int] | None:
    """Standard error of the mean, and the number of batches; None where too few are left that differ by chance."""
    length = 1
    while len(y) // length >= LEAST_BATCHES:
        count = len(y) // length
        odd = len(y) - count * length
        means = [math.fsum(y[odd + k * length:odd + (k + 1) * length]) / length for k in range(count)]
        centre = math.fsum(means) / count
        offsets = [mean - centre for mean in means]
        squares = math.fsum(offset * offset for offset in offsets)
        if squares > 0:
            # In a series of `count` values r comes out too small by (1 + 3 r) / count (Kendall, 1954).
            lag = math.fsum(a * b for a, b in zip(offsets, offsets[1:])) / squares
            correlation = (lag + 1 / count) / (1 - 3 / count)
            if correlation < MOST_CORRELATION:
                rest = max(0.0, correlation)
                return math.sqrt(squares / (count - 1) / count * (1 + rest) / (1 - rest)), count
        length = max(length + 1, int(length * BATCH_GROWTH))
    return None
