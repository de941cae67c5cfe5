# Made by scripts/write_python_stub from the module's own signatures and docstrings.
import os
import pathlib
from typing import Any, Iterator, Mapping, Optional, Sequence, Tuple, Union

import numpy
import pandas  # type: ignore[import]
from numpy.typing import ArrayLike as _Array, NDArray as _NDArray

_Path = Union[str, os.PathLike[str]]
_Value = Union[float, int, bool, str, Tuple[float, float]]

__version__: str


class Case:
    """A pump, how it runs and the pressure in its chambers, as a case file says. A mapping from the keys of the
    file, "pump.tilt_deg", to values in the file's units. Computations work on a copy made when they are
    called."""

    def __getitem__(self, key: str) -> Any:
        """Value of a parameter in the file's unit; None where it has none in this case."""

    def __setitem__(self, key: str, value: _Value) -> None:
        """Changes a parameter as if its file said so: it is held to its range, and defaults that follow from it
        follow."""

    def update(self, changes: Optional[Mapping[str, _Value]]) -> None:
        """Changes several parameters together: for those that are refused alone. All or none."""

    def __contains__(self, key: str) -> bool:
        """Whether a parameter has a value in this case."""

    def keys(self) -> list[str]:
        """Parameters that have something to do in this case."""

    def __iter__(self) -> Iterator[str]:
        """Over keys()."""

    def __len__(self) -> int:
        """Of keys()."""

    def items(self) -> list[Tuple[str, Any]]:
        """Keys with their values."""

    def validate(self) -> None:
        """Holds every parameter to its range and all to each other; raises InputError."""

    def doubts(self) -> list[Doubt]:
        """What is possible but hardly meant, as docs/plausibility.md says."""

    def summary(self) -> str:
        """The pump in a line: displacement, flow, torque, speed, pressure."""

    def write(self, path: _Path) -> None:
        """Writes a case file that reads back as this case."""

    def text(self) -> str:
        """What write() writes."""

    def copy(self) -> Case:
        """A case of its own."""

    def __copy__(self) -> Case:
        """As copy()."""

    def __deepcopy__(self, memo: Any) -> Case:
        """As copy()."""

    def __eq__(self, other: Any) -> bool:
        """Whether both write the same file."""

    def __repr__(self) -> str:
        """Name and file."""

    @property
    def name(self) -> str:
        """Name of the case."""

    @property
    def file(self) -> str:
        """Path of its file, absolute."""


class Channel:
    """One scalar result: of what, on which body, by which body, at which point, in which frame and unit."""

    @property
    def name(self) -> str:
        """Name of the column: "Rs_1_x2_N"."""

    @property
    def quantity(self) -> str:
        """"Rs"."""

    @property
    def meaning(self) -> str:
        """In words."""

    @property
    def equation(self) -> str:
        """Of Roccatello and Nervegna (2009)."""

    @property
    def piston(self) -> int:
        """From 1; 0 where it belongs to none."""

    @property
    def axis(self) -> str:
        """"x2"."""

    @property
    def frame(self) -> str:
        """"S2"."""

    @property
    def on_body(self) -> str:
        """Body that it acts on."""

    @property
    def by_body(self) -> str:
        """Body that it comes from."""

    @property
    def point(self) -> str:
        """Where it acts."""

    @property
    def unit(self) -> str:
        """"N"."""

    @property
    def group(self) -> str:
        """Channels of one group share one peak."""

    def __repr__(self) -> str:
        """Its name."""


class ChannelComparison:
    """How far apart both models are in one channel. Differences are multibody minus analytic, in the channel's
    unit."""

    @property
    def name(self) -> str:
        """Of the channel."""

    @property
    def channel(self) -> Channel:
        """What it is."""

    @property
    def verdict(self) -> str:
        """In a word."""

    @property
    def judged(self) -> bool:
        """Whether it counts for the verdict."""

    @property
    def peak(self) -> float:
        """Largest magnitude of the channel's group, at least a thousandth of the largest load of the case."""

    @property
    def own_peak(self) -> float:
        """Largest magnitude of this channel alone."""

    @property
    def largest(self) -> float:
        """Largest difference."""

    @property
    def largest_over_peak(self) -> float:
        """Largest difference over the peak."""

    @property
    def theta_of_largest_deg(self) -> float:
        """Angle of the shaft there."""

    @property
    def rms(self) -> float:
        """Root of the mean square of the difference."""

    @property
    def mean_difference(self) -> float:
        """Mean of the difference."""

    @property
    def digits(self) -> float:
        """Digits of agreement."""

    @property
    def tolerance(self) -> float:
        """Allowed difference over the peak."""

    def __repr__(self) -> str:
        """Name and verdict."""


class Check:
    """What must vanish, over a whole table."""

    @property
    def table(self) -> str:
        """Of which model."""

    @property
    def name(self) -> str:
        """What must vanish."""

    @property
    def worst(self) -> float:
        """Its largest magnitude."""

    @property
    def unit(self) -> str:
        """Unit of that."""

    @property
    def relative(self) -> float:
        """The same over its scale."""

    @property
    def holds(self) -> bool:
        """Whether it is within tolerance."""


class Comparison:
    """Both models on one case, and how far they are apart."""

    @property
    def agrees(self) -> bool:
        """The verdict: every difference is within tolerance, or what no assumption explains is, and every check
        holds."""

    @property
    def headline(self) -> str:
        """The verdict in a sentence."""

    @property
    def text(self) -> str:
        """All that the program prints."""

    @property
    def tolerance(self) -> float:
        """Allowed difference over the peak."""

    @property
    def worst(self) -> Optional[ChannelComparison]:
        """The channel with the largest difference over its peak; None where none was compared."""

    @property
    def channels(self) -> list[ChannelComparison]:
        """Every channel."""

    @property
    def groups(self) -> dict[str, ChannelComparison]:
        """By group of channels that share a peak, the one furthest apart."""

    @property
    def analytic(self) -> Table:
        """Results of the analytic model."""

    @property
    def multibody(self) -> Table:
        """Results of the multibody model."""

    @property
    def pressure(self) -> Optional[Table]:
        """What the hydraulic model found; None where the case gives its pressure."""

    @property
    def checks(self) -> list[Check]:
        """What must vanish in each model."""

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about the case and the results, which was warned of."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and the curves as the program does; returns their paths."""

    def __repr__(self) -> str:
        """The headline."""


class ComputationError(RuntimeError):
    """A computation on valid input failed: which model, where, and why."""


class Doubt:
    """A value, or values together, that are hardly meant."""

    @property
    def code(self) -> str:
        """Stable short name: "tilt-in-radians"."""

    @property
    def text(self) -> str:
        """The key with its value, the limit and its reason."""

    @property
    def reason(self) -> str:
        """Why it is meant all the same, where the case says."""

    def __repr__(self) -> str:
        """Name and text."""


class DoubtWarning(UserWarning):
    """A result can be computed but is doubtful: digits that rounding takes, a port's timing beyond its limits,
    states that are hardly meant."""


class GroupDifference:
    """How far apart the models are in a group of channels, over its peak."""

    @property
    def group(self) -> str:
        """Which channels."""

    @property
    def unit(self) -> str:
        """Of the peak."""

    @property
    def peak(self) -> float:
        """Largest magnitude."""

    @property
    def in_time(self) -> float:
        """At equal times, largest."""

    @property
    def time_s(self) -> float:
        """When that is."""

    @property
    def over_angle(self) -> float:
        """At equal angles of the shaft."""

    @property
    def of_allowed(self) -> float:
        """Largest difference over what is allowed then: 1 is the limit."""


class Identification:
    """What data say about a pump."""

    @property
    def unknowns(self) -> list[str]:
        """Names of the unknowns, in their order."""

    @property
    def values(self) -> dict[str, float]:
        """What they were found to be."""

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviations, as if the model were linear there; where the fit is refuted, with all stated
        uncertainties multiplied by birge_ratio."""

    @property
    def intervals(self) -> dict[str, Tuple[float, float]]:
        """95 % limits by their profiles; empty with fit_only and where the fit is refuted. Right only where the
        stated uncertainties are."""

    @property
    def sum_of_squares(self) -> float:
        """Of all residuals over their uncertainties: chi-square."""

    @property
    def degrees_of_freedom(self) -> int:
        """Data that count less what was fitted to them; 0: the fit cannot be tested."""

    @property
    def p_value(self) -> Optional[float]:
        """Probability of a larger sum of squares if model and stated uncertainties are right; None without
        degrees of freedom."""

    @property
    def refuted(self) -> bool:
        """Whether the data refute the model with these unknowns: p_value below 0.001. There are then no
        intervals and no bands."""

    @property
    def birge_ratio(self) -> float:
        """Root of the sum of squares over the degrees of freedom."""

    @property
    def worst_residuals(self) -> list[Tuple[str, float]]:
        """Names of the data with the largest residuals, and the residuals over their standard uncertainties, the
        largest first."""

    @property
    def further_unknowns(self) -> list[Tuple[str, float]]:
        """Of a refuted fit: parameters that would improve it most if they were unknown too, each with the sum of
        squares that would remain, the best first."""

    @property
    def minima(self) -> list[Minimum]:
        """Best first."""

    @property
    def words(self) -> list[str]:
        """What is determined only together with what, or not at all."""

    @property
    def text(self) -> str:
        """All that the program prints."""

    @property
    def case(self) -> Case:
        """The identified pump."""

    @property
    def bands(self) -> Optional[Table]:
        """Reactions over the turn with their bands; None with fit_only and where the fit is refuted."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes what the program writes; returns the files' paths."""

    def __repr__(self) -> str:
        """How many unknowns."""


class InputError(ValueError):
    """An input cannot be used: a file, a key, an argument. One line that names it, its value and what is
    allowed, in the words of the program."""


class Minimum:
    """A point at which the sum of squares is smallest nearby."""

    @property
    def values(self) -> list[float]:
        """Of the unknowns, in their order."""

    @property
    def sum_of_squares(self) -> float:
        """There."""

    @property
    def starts(self) -> int:
        """How many led there."""


class Outcome:
    """What one reference came to."""

    @property
    def name(self) -> str:
        """Of the reference."""

    @property
    def kind(self) -> str:
        """What kind of reference it is."""

    @property
    def state(self) -> str:
        """"agrees", "differs", "unusable" or "failed"."""

    @property
    def error(self) -> str:
        """Why it differs as a whole, is unusable or failed."""

    @property
    def groups(self) -> list[ReferenceGroup]:
        """What was found of each group of channels of each model."""

    @property
    def explanation(self) -> str:
        """Where it differs: which parameters of the case would explain it, in words."""

    @property
    def notes(self) -> list[str]:
        """What else there is to know."""

    def result(self, model: str) -> Optional[Table]:
        """What a model gave; None where it was not run."""

    def reference(self, model: str) -> Optional[Table]:
        """The reference at the same angles."""

    def __repr__(self) -> str:
        """Name and state."""


class Parameter:
    """A parameter of a case file."""

    @property
    def unit(self) -> str:
        """Unit of its value; "" where it has none."""

    @property
    def symbol(self) -> str:
        """Symbol in the paper or in the documentation."""

    @property
    def meaning(self) -> str:
        """What it is."""

    @property
    def range(self) -> str:
        """What it may be."""

    @property
    def words(self) -> list[str]:
        """Of a choice: its words."""


class PeriodicMotion:
    """A motion that repeats itself."""

    @property
    def period_s(self) -> float:
        """Its period."""

    @property
    def speed_rad_per_s(self) -> float:
        """Mean speed of the shaft."""

    @property
    def iterations(self) -> int:
        """Of the search."""

    @property
    def error(self) -> float:
        """How far a state is off, of its scale."""

    @property
    def multipliers(self) -> list[complex]:
        """Floquet's, largest magnitude first."""

    @property
    def stable(self) -> bool:
        """Whether disturbances die away."""


class PlausibilityWarning(DoubtWarning):
    """A case is valid but implausible: a value, or values together, as Case.doubts() lists them."""


class ReferenceGroup:
    """A group of channels of one model, held against one reference."""

    @property
    def reference(self) -> str:
        """Name of the reference."""

    @property
    def kind(self) -> str:
        """What kind of reference that is."""

    @property
    def model(self) -> str:
        """Of which model."""

    @property
    def group(self) -> str:
        """Which channels."""

    @property
    def compared(self) -> int:
        """Number of channels that were compared."""

    @property
    def missing(self) -> int:
        """Number of those the reference has not."""

    @property
    def failed(self) -> int:
        """Number of those that differ."""

    @property
    def verdict(self) -> str:
        """In a word."""

    @property
    def text(self) -> str:
        """Where it is worst and what that looks like."""

    def __repr__(self) -> str:
        """What it is and its verdict."""


class Regression:
    """Both models held to stored curves."""

    @property
    def agrees(self) -> bool:
        """Whether all do."""

    @property
    def summary(self) -> str:
        """All in a sentence."""

    @property
    def text(self) -> str:
        """All that the program prints."""

    @property
    def outcomes(self) -> list[Outcome]:
        """What each reference came to."""

    def write_junit(self, path: _Path) -> None:
        """Writes a JUnit file for CI."""

    def __repr__(self) -> str:
        """The summary."""


class Simulation:
    """Motion in time by both models, or by one alone, and how far they are apart."""

    @property
    def agrees(self) -> bool:
        """Whether both models agree; of one model alone: whether its checks hold."""

    @property
    def headline(self) -> str:
        """The verdict in a sentence."""

    @property
    def text(self) -> str:
        """All that the program prints."""

    @property
    def analytic(self) -> Optional[Table]:
        """What the analytic model found, over time; None where it was not asked."""

    @property
    def multibody(self) -> Optional[Table]:
        """What the multibody model found; None where it was not asked."""

    @property
    def oil_analytic(self) -> Optional[Table]:
        """What the oil does; None where it does not follow the motion."""

    @property
    def oil_multibody(self) -> Optional[Table]:
        """Likewise."""

    @property
    def teeth_analytic(self) -> Optional[Table]:
        """What the teeth do; None where the contact is none of teeth."""

    @property
    def teeth_multibody(self) -> Optional[Table]:
        """Likewise."""

    @property
    def periodic_analytic(self) -> Optional[PeriodicMotion]:
        """The motion it settles to; None where it was not asked for."""

    @property
    def periodic_multibody(self) -> Optional[PeriodicMotion]:
        """Likewise."""

    @property
    def groups(self) -> list[GroupDifference]:
        """How far apart the models are."""

    @property
    def checks(self) -> list[Check]:
        """What must vanish."""

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about the case and the motion, which was warned of."""

    @property
    def judged_until_s(self) -> float:
        """Later a disturbance of the wanted error would change results altogether."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and the curves as the program does; returns their paths."""

    def __repr__(self) -> str:
        """The headline."""


class Sweep(Table):
    """A table of designs: parameters that vary, in the units of the case file, and outputs. A choice is the
    place of its word, from 0."""

    @property
    def infeasible(self) -> dict[int, str]:
        """Why designs have no outputs, by their rows."""

    @property
    def checks(self) -> list[SweepCheck]:
        """Designs that the other model computed too."""

    @property
    def agrees(self) -> bool:
        """Whether all that were checked do."""

    @property
    def headline(self) -> str:
        """What came out, in a line."""

    @property
    def seconds(self) -> float:
        """What the computation took."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and sweep.csv as the program does; returns their paths."""


class SweepCheck:
    """A design that the other model computed too."""

    @property
    def design(self) -> int:
        """Its row."""

    @property
    def own(self) -> list[float]:
        """Outputs of the sweep's model."""

    @property
    def values(self) -> list[float]:
        """Outputs of the other one."""

    @property
    def scales(self) -> list[float]:
        """What differences are over; 0: not compared."""

    @property
    def agrees(self) -> bool:
        """Whether both refuse it or all outputs are within 1e-9 of their scales."""


class Table:
    """Columns of numbers by name. They are looks at the memory that the computation filled: nothing is copied,
    nothing can be written, and it stays as long as any array does. NaN: not computed."""

    def __getitem__(self, name: str) -> _NDArray[numpy.float64]:
        """A column as an array; its name may lack the unit and, of a quantity of one component, the axis:
        "Td_z1_Nm", "Td_z1", "Td_Nm", "Td"."""

    def __contains__(self, name: Any) -> bool:
        """Whether there is such a column: whether [name] gives one."""

    def __iter__(self) -> Iterator[str]:
        """Over names."""

    def __len__(self) -> int:
        """Number of rows."""

    def keys(self) -> list[str]:
        """As names."""

    @property
    def names(self) -> list[str]:
        """Names of the columns; the first says where a row is, by angle or time."""

    @property
    def name(self) -> str:
        """Who computed it."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        """All columns as one array, row by row, in the order of `names`; a copy."""

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about the case or the results, which was warned of."""

    @property
    def values(self) -> _NDArray[numpy.float64]:
        """All columns of `channels` as one array, row by row."""

    @property
    def channels(self) -> list[str]:
        """Names of the columns of `values`."""

    def unit(self, name: str) -> str:
        """Unit of a column."""

    def meaning(self, name: str) -> str:
        """What a column is: on which body, by which, where, in which frame."""

    def channel(self, name: str) -> Optional[Channel]:
        """The same by parts; None where it is no result of a model."""

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas.DataFrame over angle or time, units in its attrs. Needs pandas."""

    def write_csv(self, path: _Path) -> None:
        """Writes the file that the program writes: the shortest text that reads back to the same numbers."""

    def __repr__(self) -> str:
        """Name and size."""


def compare(case: Case, multibody: Optional[Mapping[str, _Value]] = None, *, analytic: Optional[Mapping[str, _Value]] = None, multibody_case: Optional[Case] = None, channels: Union[str, Sequence[str], None] = None, tolerance: Optional[float] = None) -> Comparison:
    """Runs both models over one turn and compares them. `multibody`, `analytic`: what a model assumes instead of
    what the case says, {"piston_friction": False, "gear": "imposed"}: the difference is then taken apart.
    `multibody_case`: another case for the multibody model. `channels`: only these."""


def data_folder(name: str = 'cases') -> str:
    """Folder of what comes with bentaxis: "cases" or "reference_data"."""


def identify(case: Case, data: Union[_Path, Sequence[_Path]], unknowns: Optional[Mapping[str, Tuple[float, float]]] = None, *, starts: int = 8, seed: int = 1, steps: int = 2000, draws: int = 400, measured: float = 0.01, fit_only: bool = False, threads: int = 0) -> Identification:
    """Determines parameters from printed numbers, windows and records (docs/identification.md). `data`: a file
    or several. `unknowns`: further ones, lowest and highest value by name. `fit_only`: least squares alone,
    without profiles, posterior and leaving out. Needs a build with Ceres."""


def parameter(key: str) -> Parameter:
    """What is known of a parameter: unit, symbol, meaning, range."""


def parameters() -> list[str]:
    """Every key that a case file may have."""


def parse_case(text: str, path: _Path = 'case.toml') -> Case:
    """The same of a text; `path` stands in messages and says where files are that it names."""


def read_case(path: _Path, changes: Optional[Mapping[str, _Value]] = None) -> Case:
    """Reads a case file. Files that it names are found from it, wherever the program goes later. `changes`: as
    if the file said so."""


def regress(folder: Optional[_Path] = None, filter: str = '') -> Regression:
    """Holds both models to the references of a folder, or to those that come with bentaxis. `filter`: only those
    whose name contains it."""


def run(case: Case, model: str = 'analytic', channels: Union[str, Sequence[str], None] = None) -> Table:
    """Reactions over one turn at constant speed by one model, "analytic" or "multibody". `channels`: only these
    quantities ("Rs") or columns ("Rs_1_z2_N"), by the smallest scene that computes them."""


def run_states(case: Case, states: Union[_Path, Mapping[str, _Array]], model: str = 'analytic', channels: Union[str, Sequence[str], None] = None) -> Table:
    """Reactions at given states of shaft and block: a CSV file (docs/motion.md) or arrays by the names of its
    columns. Messages count arrays from 0."""


def simulate(case: Case, model: Optional[str] = None, *, error: float = 1e-06, oil: str = 'coupled', steady: bool = False) -> Simulation:
    """Integrates the motion of shaft and block in time, as [drive] of the case says, by both models or by one.
    `error`: wanted error of every reaction, of its peak, in [1e-10, 0.1]. `oil`, of a hydraulic case:
    "coupled" or "periodic". `steady`: the motion that repeats itself, and its stability."""


def sweep(case: Case, vary: Mapping[str, Union[str, float, bool, Sequence[_Value], _Array]], outputs: Union[str, Sequence[str], None], *, sampling: str = 'grid', samples: int = 0, seed: int = 1, model: str = 'analytic', check: float = 0.0, minimise: Union[str, Sequence[str], None] = None, maximise: Union[str, Sequence[str], None] = None, threads: int = 0) -> Sweep:
    """Outputs of many designs (docs/sweeps.md), on all processors or `threads` of them. `vary`: values by
    parameter, a list, an array or a text as "20:40:5" or, where they are sampled, "normal(40, 0.1)".
    `outputs`: "max:Rb1_z1", "mean:Td". `sampling`: "grid", or "lhs", "sobol", "random" with a number of
    `samples`. `check`: share of the designs that the other model computes too."""


def versions() -> list[Tuple[str, str]]:
    """Name and version of everything that results depend on."""
