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
    """A case: pump, operating point and chamber pressure. A mapping from the keys of the case file, such as
    "pump.tilt_deg", to values in the units of the file. Each computation uses a copy made at the call."""

    def __getitem__(self, key: str) -> Any:
        """Value of a parameter in the file's unit; None where it has none in this case."""

    def __setitem__(self, key: str, value: _Value) -> None:
        """Changes a parameter as if its file said so: its range is checked, and defaults that depend on it are
        updated."""

    def update(self, changes: Optional[Mapping[str, _Value]]) -> None:
        """Changes several parameters at once, where single changes would be refused. All are changed or none."""

    def __contains__(self, key: str) -> bool:
        """Whether a parameter has a value in this case."""

    def keys(self) -> list[str]:
        """Keys of the parameters that are active in this case."""

    def __iter__(self) -> Iterator[str]:
        """Iterates over keys()."""

    def __len__(self) -> int:
        """Number of keys()."""

    def items(self) -> list[Tuple[str, Any]]:
        """Keys with their values."""

    def validate(self) -> None:
        """Checks the range of every parameter and their consistency; raises InputError."""

    def doubts(self) -> list[Doubt]:
        """Plausibility warnings of the case (docs/plausibility.md)."""

    def summary(self) -> str:
        """The pump in a line: displacement, flow, torque, speed, pressure."""

    def write(self, path: _Path) -> None:
        """Writes a case file; reading it gives the same case."""

    def text(self) -> str:
        """Text of the case file."""

    def copy(self) -> Case:
        """Copy of the case."""

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
    """One scalar result: quantity, body, acting body, point, frame and unit."""

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
        """Equation of Roccatello and Nervegna (2009)."""

    @property
    def piston(self) -> int:
        """Piston, from 1; 0 where the channel belongs to none."""

    @property
    def axis(self) -> str:
        """"x2"."""

    @property
    def frame(self) -> str:
        """"S2"."""

    @property
    def on_body(self) -> str:
        """Body on which it acts."""

    @property
    def by_body(self) -> str:
        """Body that exerts it."""

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
    """Difference of the two models in one channel: multibody minus analytic, in the unit of the channel."""

    @property
    def name(self) -> str:
        """Name of the channel."""

    @property
    def channel(self) -> Channel:
        """Description of the channel."""

    @property
    def verdict(self) -> str:
        """In a word."""

    @property
    def judged(self) -> bool:
        """Whether the channel counts for the verdict."""

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
        """Angle of the shaft at the largest difference."""

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
    """A check: a quantity that must be zero in every row of a table."""

    @property
    def table(self) -> str:
        """Model of the table."""

    @property
    def name(self) -> str:
        """Quantity that must be zero."""

    @property
    def worst(self) -> float:
        """Largest magnitude of the quantity."""

    @property
    def unit(self) -> str:
        """Unit of that."""

    @property
    def relative(self) -> float:
        """Largest magnitude over its scale."""

    @property
    def holds(self) -> bool:
        """Whether it is within tolerance."""


class ChosenDesign:
    """A chosen design of the front."""

    @property
    def why(self) -> str:
        """"lowest peak:Rb1", "balanced"."""

    @property
    def design(self) -> int:
        """Row of the design."""


class Comparison:
    """Results of both models on one case, and their differences."""

    @property
    def agrees(self) -> bool:
        """Verdict: every difference, less what stated assumptions explain, is within tolerance, and every check
        is passed."""

    @property
    def headline(self) -> str:
        """The verdict in a sentence."""

    @property
    def text(self) -> str:
        """Text that the program prints."""

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
        """For each group of channels with a common peak, the channel with the largest difference."""

    @property
    def analytic(self) -> Table:
        """Results of the analytic model."""

    @property
    def multibody(self) -> Table:
        """Results of the multibody model."""

    @property
    def pressure(self) -> Optional[Table]:
        """Results of the hydraulic model; None where the pressure is given by the case."""

    @property
    def checks(self) -> list[Check]:
        """Checks of each model."""

    @property
    def warnings(self) -> list[str]:
        """Warnings about the case and the results."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and the curves as the program does; returns their paths."""

    def __repr__(self) -> str:
        """The headline."""


class ComputationError(RuntimeError):
    """A computation on valid input failed: which model, where, and why."""


class Doubt:
    """A plausibility warning: a value, or a combination of values, that is implausible."""

    @property
    def code(self) -> str:
        """Stable short name: "tilt-in-radians"."""

    @property
    def text(self) -> str:
        """The key with its value, the limit and its reason."""

    @property
    def reason(self) -> str:
        """Reason why the value is intended, where the case gives one."""

    def __repr__(self) -> str:
        """Name and text."""


class DoubtWarning(UserWarning):
    """A result was computed, but with a warning: digits lost to round-off, port timing outside its limits,
    implausible states."""


class GroupDifference:
    """Difference of the models in a group of channels, relative to its peak."""

    @property
    def group(self) -> str:
        """Group of channels."""

    @property
    def unit(self) -> str:
        """Of the peak."""

    @property
    def peak(self) -> float:
        """Largest magnitude."""

    @property
    def in_time(self) -> float:
        """Largest difference at equal times."""

    @property
    def time_s(self) -> float:
        """When that is."""

    @property
    def over_angle(self) -> float:
        """Largest difference at equal angles of the shaft."""

    @property
    def of_allowed(self) -> float:
        """Largest difference over the tolerance at that time: 1 is the limit."""


class Identification:
    """Result of an identification: parameters of a pump determined from data."""

    @property
    def unknowns(self) -> list[str]:
        """Names of the unknowns, in their order."""

    @property
    def values(self) -> dict[str, float]:
        """Identified values."""

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviations, as if the model were linear there; where the fit is refuted, with all stated
        uncertainties multiplied by birge_ratio."""

    @property
    def intervals(self) -> dict[str, Tuple[float, float]]:
        """95 % limits from profile likelihoods; empty with fit_only and where the fit is refuted. Valid only if
        the stated uncertainties are."""

    @property
    def sum_of_squares(self) -> float:
        """Chi-square: sum of squares of all residuals over their uncertainties."""

    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom: number of data less number of fitted values; 0: the fit cannot be tested."""

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
        """Unknowns that are determined only in combination, or not at all."""

    @property
    def text(self) -> str:
        """Text that the program prints."""

    @property
    def case(self) -> Case:
        """The identified pump."""

    @property
    def bands(self) -> Optional[Table]:
        """Reactions over the turn with their bands; None with fit_only and where the fit is refuted."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes the same files as the program; returns their paths."""

    def __repr__(self) -> str:
        """Number of unknowns."""


class InputError(ValueError):
    """An input (file, key or argument) cannot be used. The message names it, its value and what is allowed."""


class Minimum:
    """A local minimum of the sum of squares."""

    @property
    def values(self) -> list[float]:
        """Values of the unknowns, in their order."""

    @property
    def sum_of_squares(self) -> float:
        """There."""

    @property
    def starts(self) -> int:
        """Number of starts that ended there."""


class Optimisation(Table):
    """A table of all designs that a search evaluated: parameters that vary and outputs, in the order of the
    evaluations."""

    @property
    def chosen(self) -> list[ChosenDesign]:
        """The best design of each objective and a balanced one; empty where no design keeps all constraints."""

    @property
    def front(self) -> list[int]:
        """Rows of the Pareto front."""

    @property
    def infeasible(self) -> dict[int, str]:
        """Reasons why designs are infeasible or have no outputs, by row."""

    @property
    def headline(self) -> str:
        """Summary in one line."""

    @property
    def answers(self) -> list[str]:
        """The chosen designs and how sure they are, in sentences."""

    @property
    def seconds(self) -> float:
        """What the search took."""

    def case(self, design: int) -> Case:
        """The case of a row."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json, front.csv, evaluations.csv and the chosen cases as the program does;
        returns their paths."""


class Outcome:
    """Result for one reference."""

    @property
    def name(self) -> str:
        """Name of the reference."""

    @property
    def kind(self) -> str:
        """Kind of the reference."""

    @property
    def state(self) -> str:
        """"agrees", "differs", "unusable" or "failed"."""

    @property
    def error(self) -> str:
        """Why it differs as a whole, is unusable or failed."""

    @property
    def groups(self) -> list[ReferenceGroup]:
        """Result for each group of channels of each model."""

    @property
    def explanation(self) -> str:
        """Where it differs: which parameters of the case would explain it, in words."""

    @property
    def notes(self) -> list[str]:
        """Further remarks."""

    def result(self, model: str) -> Optional[Table]:
        """Results of a model; None where it was not run."""

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
        """Meaning of the parameter."""

    @property
    def range(self) -> str:
        """Allowed values."""

    @property
    def words(self) -> list[str]:
        """Allowed words, for a choice."""


class PeriodicMotion:
    """A periodic motion."""

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
        """Largest error of a state, relative to its scale."""

    @property
    def multipliers(self) -> list[complex]:
        """Floquet multipliers, largest magnitude first."""

    @property
    def stable(self) -> bool:
        """Whether disturbances decay."""


class PlausibilityWarning(DoubtWarning):
    """A case is valid but implausible: a plausibility warning, as listed by `Case.doubts()`."""


class ReferenceGroup:
    """Comparison of a group of channels of one model with one reference."""

    @property
    def reference(self) -> str:
        """Name of the reference."""

    @property
    def kind(self) -> str:
        """Kind of the reference."""

    @property
    def model(self) -> str:
        """Name of the model."""

    @property
    def group(self) -> str:
        """Group of channels."""

    @property
    def compared(self) -> int:
        """Number of channels that were compared."""

    @property
    def missing(self) -> int:
        """Number of channels that the reference does not have."""

    @property
    def failed(self) -> int:
        """Number of channels that differ."""

    @property
    def verdict(self) -> str:
        """In a word."""

    @property
    def text(self) -> str:
        """Channel and angle of the largest difference, and its likely kind."""

    def __repr__(self) -> str:
        """Group and verdict."""


class Regression:
    """Comparison of both models with stored curves."""

    @property
    def agrees(self) -> bool:
        """Whether all references agree."""

    @property
    def summary(self) -> str:
        """Summary in one sentence."""

    @property
    def text(self) -> str:
        """Text that the program prints."""

    @property
    def outcomes(self) -> list[Outcome]:
        """Result for each reference."""

    def write_junit(self, path: _Path) -> None:
        """Writes a JUnit file for CI."""

    def __repr__(self) -> str:
        """The summary."""


class Simulation:
    """Motion in time by both models, or by one, and their differences."""

    @property
    def agrees(self) -> bool:
        """Whether both models agree; of one model: whether its checks are passed."""

    @property
    def headline(self) -> str:
        """The verdict in a sentence."""

    @property
    def text(self) -> str:
        """Text that the program prints."""

    @property
    def analytic(self) -> Optional[Table]:
        """Results of the analytic model over time; None where it was not run."""

    @property
    def multibody(self) -> Optional[Table]:
        """Results of the multibody model; None where it was not run."""

    @property
    def oil_analytic(self) -> Optional[Table]:
        """Results of the oil; None where it does not follow the motion."""

    @property
    def oil_multibody(self) -> Optional[Table]:
        """Likewise."""

    @property
    def teeth_analytic(self) -> Optional[Table]:
        """Results of the teeth; None without resolved tooth contact."""

    @property
    def teeth_multibody(self) -> Optional[Table]:
        """Likewise."""

    @property
    def periodic_analytic(self) -> Optional[PeriodicMotion]:
        """Periodic motion; None where it was not requested."""

    @property
    def periodic_multibody(self) -> Optional[PeriodicMotion]:
        """Likewise."""

    @property
    def groups(self) -> list[GroupDifference]:
        """Differences of the models."""

    @property
    def checks(self) -> list[Check]:
        """Checks: quantities that must be zero."""

    @property
    def warnings(self) -> list[str]:
        """Warnings about the case and the motion."""

    @property
    def judged_until_s(self) -> float:
        """Time up to which results are compared; after it a disturbance of the wanted error is amplified too
        much."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and the curves as the program does; returns their paths."""

    def __repr__(self) -> str:
        """The headline."""


class Sweep(Table):
    """A table of designs: parameters that vary, in the units of the case file, and outputs. A choice is the
    index of its word, from 0."""

    @property
    def infeasible(self) -> dict[int, str]:
        """Reasons why designs have no outputs, by row."""

    @property
    def checks(self) -> list[SweepCheck]:
        """Designs that were also computed by the other model."""

    @property
    def agrees(self) -> bool:
        """Whether all designs that both models computed agree, and there are any, where designs were to be
        checked."""

    @property
    def headline(self) -> str:
        """Summary in one line."""

    @property
    def seconds(self) -> float:
        """Elapsed time of the computation."""

    def report(self, folder: _Path) -> list[pathlib.Path]:
        """Writes report.html, report.json and sweep.csv as the program does; returns their paths."""


class SweepCheck:
    """A design that was also computed by the other model."""

    @property
    def design(self) -> int:
        """Row of the design."""

    @property
    def own(self) -> list[float]:
        """Outputs by the model of the sweep."""

    @property
    def values(self) -> list[float]:
        """Outputs by the other model."""

    @property
    def scales(self) -> list[float]:
        """Scales that differences are relative to; 0: not compared."""

    @property
    def agrees(self) -> Optional[bool]:
        """Whether all outputs agree within 1e-9 of their scales; None where nothing was compared, as where both
        models refuse the design."""


class Table:
    """Columns of numbers by name. Arrays are read-only views of the memory of the computation, which is kept as
    long as any view exists; nothing is copied. NaN: not computed."""

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
        """Names of the columns; the first is the angle or the time of a row."""

    @property
    def name(self) -> str:
        """Model that computed it."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        """All columns as one array, row by row, in the order of `names`; a copy."""

    @property
    def warnings(self) -> list[str]:
        """Warnings about the case or the results."""

    @property
    def values(self) -> _NDArray[numpy.float64]:
        """All columns of `channels` as one array, row by row."""

    @property
    def channels(self) -> list[str]:
        """Names of the columns of `values`."""

    def unit(self, name: str) -> str:
        """Unit of a column."""

    def meaning(self, name: str) -> str:
        """Description of a column: body, acting body, point, frame."""

    def channel(self, name: str) -> Optional[Channel]:
        """Description of a column as an object; None where it is not a result of a model."""

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas.DataFrame over angle or time, units in its attrs. Needs pandas."""

    def write_csv(self, path: _Path) -> None:
        """Writes the same CSV file as the program: the shortest text that reads back to the same numbers."""

    def __repr__(self) -> str:
        """Name and size."""


def cases() -> dict[str, str]:
    """Names of the cases that come with bentaxis, with their titles; read_case() takes a name."""


def compare(case: Case, multibody: Optional[Mapping[str, _Value]] = None, *, analytic: Optional[Mapping[str, _Value]] = None, multibody_case: Optional[Case] = None, channels: Union[str, Sequence[str], None] = None, tolerance: Optional[float] = None) -> Comparison:
    """Runs both models over one turn and compares them. `multibody`, `analytic`: assumptions of a model that
    override the case, {"piston_friction": False, "gear": "imposed"}: the difference is then split by
    assumption. `multibody_case`: another case for the multibody model. `channels`: only these channels."""


def data_folder(name: str = 'cases') -> str:
    """Directory of files that come with bentaxis: "cases" or "reference_data"."""


def identify(case: Case, data: Union[_Path, Sequence[_Path]], unknowns: Optional[Mapping[str, Tuple[float, float]]] = None, *, starts: int = 8, seed: int = 1, steps: int = 2000, draws: int = 400, measured: float = 0.01, fit_only: bool = False, threads: int = 0) -> Identification:
    """Determines parameters from printed numbers, windows and records (docs/identification.md). `data`: a file
    or several. `unknowns`: further unknowns, minimum and maximum by name. `fit_only`: least squares only,
    without profiles, posterior and leave-one-out. Needs a build with Ceres."""


def optimise(case: Case, vary: Mapping[str, Union[str, float, bool, Sequence[_Value], _Array]], minimise: Union[str, Sequence[str], None] = None, maximise: Union[str, Sequence[str], None] = None, subject_to: Union[str, Sequence[str], None] = None, *, outputs: Union[str, Sequence[str], None] = None, conditions: Optional[_Path] = None, population: int = 64, generations: int = 50, restarts: int = 2, seed: int = 1, refine: bool = True, samples: int = 100, comparison: str = 'fast', model: str = 'analytic', threads: int = 0) -> Optimisation:
    """The best designs (docs/optimisation.md). `vary`: a range "25:42" or a list of values by parameter.
    `minimise`, `maximise`: outputs, also quantiles under [uncertainty] as "q95:peak:Rb1", from `samples` of
    it. `subject_to`: "peak:Rs <= 13000". `conditions`: a file of operating points. `comparison`: random and
    grid search beside it, "fast", "yes" or "no"."""


def parameter(key: str) -> Parameter:
    """Unit, symbol, meaning and range of a parameter."""


def parameters() -> list[str]:
    """All keys that a case file may have."""


def parse_case(text: str, path: _Path = 'case.toml') -> Case:
    """Reads a case from a text. `path` appears in messages, and files named in the text are found from its
    directory."""


def read_case(path: _Path, changes: Optional[Mapping[str, _Value]] = None) -> Case:
    """Reads a case file, or the shipped case of this name (cases()). Files that the case names are found from
    its own directory. `changes`: as if the file said so."""


def regress(folder: Optional[_Path] = None, filter: str = '') -> Regression:
    """Compares both models with the references in a directory, or with those that come with bentaxis. `filter`:
    only references whose name contains this text."""


def run(case: Case, model: str = 'analytic', channels: Union[str, Sequence[str], None] = None) -> Table:
    """Reactions over one turn at constant speed by one model, "analytic" or "multibody". `channels`: only these
    quantities ("Rs") or columns ("Rs_1_z2_N"), by the smallest scene that computes them."""


def run_states(case: Case, states: Union[_Path, Mapping[str, _Array]], model: str = 'analytic', channels: Union[str, Sequence[str], None] = None) -> Table:
    """Reactions at given states of shaft and block: a CSV file (docs/motion.md) or arrays by the names of its
    columns. Messages count arrays from 0."""


def simulate(case: Case, model: Optional[str] = None, *, error: float = 1e-06, oil: str = 'coupled', steady: bool = False) -> Simulation:
    """Integrates the motion of shaft and block in time, with the drive in [drive] of the case, by both models or
    by one. `error`: wanted error of every reaction, relative to its peak, in [1e-10, 0.1]. `oil`, of a
    hydraulic case: "coupled" or "periodic". `steady`: the periodic motion and its stability."""


def sweep(case: Case, vary: Mapping[str, Union[str, float, bool, Sequence[_Value], _Array]], outputs: Union[str, Sequence[str], None], *, sampling: str = 'grid', samples: int = 0, seed: int = 1, model: str = 'analytic', check: float = 0.0, minimise: Union[str, Sequence[str], None] = None, maximise: Union[str, Sequence[str], None] = None, threads: int = 0) -> Sweep:
    """Outputs of many designs (docs/sweeps.md), on all processors or `threads` of them. `vary`: values by
    parameter, a list, an array or a text as "20:40:5" or, where they are sampled, "normal(40, 0.1)".
    `outputs`: "max:Rb1_z1", "mean:Td". `sampling`: "grid", or "lhs", "sobol", "random" with a number of
    `samples`. `check`: share of the designs that the other model computes too."""


def versions() -> list[Tuple[str, str]]:
    """Names and versions of all software that results depend on."""
