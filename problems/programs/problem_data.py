"""The data of a problem in SI units, and files of its columns. Needs nothing but Python 3.11."""
import tomllib
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

FOLDER = Path(__file__).resolve().parent.parent

# Ending of a key: exact factor to SI, and whether pi / 180 or pi / 30 comes with it.
UNITS = {"_kg_mm2": (Fraction(1, 10**6), 0), "_m_per_s2": (1, 0), "_N_s_per_m": (1, 0), "_Nm_s_per_rad": (1, 0), "_mm2": (Fraction(1, 10**6), 0),
         "_mm": (Fraction(1, 1000), 0), "_m_per_s": (1, 0), "_deg": (Fraction(1, 180), 1), "_rpm": (Fraction(1, 30), 1),
         "_bar": (10**5, 0), "_kg": (1, 0), "_Nm": (1, 0), "_N": (1, 0)}


def settings_of(name):
    """problem.toml of a problem; numbers with a decimal point are exact fractions."""
    with open(FOLDER / name / "problem.toml", "rb") as stream:
        return tomllib.load(stream, parse_float=Fraction)


def data_of(number, settings, changed=None):
    """[data] as attributes without their units, in SI. `changed` (key, factor) multiplies one value."""
    result = SimpleNamespace()
    for key, value in settings["data"].items():
        unit = next((u for u in UNITS if key.endswith(u)), "")
        factor, with_pi = UNITS.get(unit, (1, 0))

        def si(x, factor=factor, with_pi=with_pi, key=key):
            exact = Fraction(x) * factor
            at = number.array(exact.numerator)[()] / number.array(exact.denominator)[()]
            at = at * number.pi if with_pi else at
            return at * changed[1] if changed and changed[0] == key else at

        if isinstance(value, str):
            setattr(result, key, value)
        else:
            setattr(result, key.removesuffix(unit), [si(x) for x in value] if isinstance(value, list) else si(value))
    return result


def grid_of(settings):
    """Values of the column that the curves stand over, exact."""
    grid = settings["grid"]
    return [Fraction(grid["from"]) + Fraction(grid["step"]) * i for i in range(grid["count"])]


def write_table(path, over, xs, rows, text=repr):
    """A CSV file: the column `over`, then the columns of the rows, which are dictionaries."""
    names = list(rows[0])
    lines = [",".join([over] + names)]
    lines += [",".join([repr(float(x))] + [text(row[name]) for name in names]) for x, row in zip(xs, rows)]
    Path(path).write_text("\n".join(lines) + "\n")
