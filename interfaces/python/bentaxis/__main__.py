"""python -m bentaxis: the program, with the arguments given."""

import os
import pathlib
import sys


def _program():
    here = pathlib.Path(__file__).resolve().parent
    # As installed, PREFIX/lib/python3/dist-packages/bentaxis; as built, build/python/bentaxis.
    for program in (here.parents[3] / "bin" / "bentaxis", here.parents[1] / "cli" / "bentaxis"):
        if program.is_file():
            return program
    sys.exit(f"bentaxis: the program is not beside the module in {here}; install both")


if __name__ == "__main__":
    program = _program()
    os.execv(program, [program, *sys.argv[1:]])
