"""What `pip install .` calls (PEP 517): builds the program and its Python module by scripts/build, packs them as a wheel.

The wheel has the Python package, the program `bentaxis`, its modules and its data, in the layout of an installation:
PREFIX/bin, PREFIX/lib and PREFIX/share of the environment that it is installed into. It links the Debian libraries of
scripts/packages.txt and is for this machine's Python alone.

pip install . --config-settings build=FOLDER packs a finished build, and compiles nothing.
"""

import base64
import gzip
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
GROUPS = {"build", "libraries", "python"}
FIRST_DAY = (1980, 1, 1, 0, 0, 0)  # of a zip archive: the same sources give the same bytes
PACKAGES = pathlib.PurePosixPath("lib/python3/dist-packages")  # as CMake installs them


def fail(message):
    """pip prints the output of a build that failed: this line, without a traceback."""
    sys.exit(f"bentaxis: {message}")


def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def version():
    return re.search(r"project\(bentaxis VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def metadata():
    about = project()
    fields = [("Metadata-Version", "2.1"), ("Name", about["name"]), ("Version", version()),
              ("Summary", about["description"]), ("License", about["license"]["text"]),
              ("Requires-Python", about["requires-python"])]
    fields += [("Requires-Dist", name) for name in about["dependencies"]]
    return "".join(f"{name}: {value}\n" for name, value in fields)


def require_packages():
    """Ends where a Debian package is missing. On other systems CMake says what it does not find."""
    if not shutil.which("dpkg-query"):
        return
    lines = (line.split() for line in (ROOT / "scripts" / "packages.txt").read_text().splitlines())
    needed = sorted({words[1] for words in lines if len(words) == 2 and words[0] in GROUPS})
    said = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Status}\n", *needed], capture_output=True, text=True)
    installed = {line.split()[0] for line in said.stdout.splitlines() if line.endswith("install ok installed")}
    missing = [name for name in needed if name not in installed]
    if missing:
        fail(f"missing Debian packages, to be installed by root: apt-get install {' '.join(missing)}")


def cached(build, name):
    found = re.search(rf"^{name}:\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found[1] if found else None


def finished_build(settings):
    """The folder of a build of this version: the given one, else build/, which scripts/build makes."""
    given = (settings or {}).get("build")
    if given:
        build = pathlib.Path(given).resolve()
        if not (build / "CMakeCache.txt").is_file():
            fail(f"--config-settings build={given}: is not the folder of a build")
        if cached(build, "CMAKE_PROJECT_VERSION") != version():
            fail(f"--config-settings build={given}: is of version {cached(build, 'CMAKE_PROJECT_VERSION')}, "
                 f"not {version()}")
        return build
    if subprocess.run([ROOT / "scripts" / "build", "package"]).returncode != 0:
        fail("the build failed; the output above says why")
    return ROOT / "build"


def installed_files(build, prefix):
    """(place in the wheel, file) of what CMake installs, but headers, archives of the linker and documents."""
    run = subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--strip"], capture_output=True, text=True)
    if run.returncode != 0:
        fail(f"{build} cannot be installed: {run.stderr.strip().splitlines()[-1]}")
    data = f"bentaxis-{version()}.data"
    for file in sorted(path for path in prefix.rglob("*") if path.is_file()):
        place = pathlib.PurePosixPath(file.relative_to(prefix))
        if place.is_relative_to(PACKAGES):
            yield str(place.relative_to(PACKAGES)), file
        elif place.parts[0] == "bin":
            yield f"{data}/scripts/{place.name}", file
        elif place.parts[0] in ("lib", "share") and "bentaxis" in place.parts[1:-1] and not (
                {"doc", "cmake"} & set(place.parts)):
            yield f"{data}/data/{place}", file
    yield f"bentaxis-{version()}.dist-info/licenses/LICENSE", ROOT / "LICENSE"
    yield f"bentaxis-{version()}.dist-info/licenses/third_party.txt", build / "package_notices.txt"


def tag_of(modules):
    """As pip compares it with the Python it installs for, from the name of the module's file."""
    if not modules:
        fail("the build has no Python module: python3-dev and pybind11-dev were missing when it was configured")
    python, machine = re.fullmatch(r"_bentaxis\.cpython-(\d+)-(\w+)-linux-gnu\.so", modules[0]).groups()
    running = f"{sys.version_info[0]}{sys.version_info[1]}"
    if python != running:
        fail(f"the module is built for Debian's Python {python[0]}.{python[1:]}, and this is {running[0]}.{running[1:]}")
    return f"cp{python}-cp{python}-linux_{machine}"


class Wheel:
    def __init__(self, file):
        self.archive = zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED)
        self.record = []

    def add(self, place, content, rights=0o644):
        entry = zipfile.ZipInfo(place, FIRST_DAY)
        entry.external_attr = (0o100000 | rights) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        self.archive.writestr(entry, content)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self.record.append(f"{place},sha256={digest},{len(content)}\n")

    def close(self, place):
        self.add(place, "".join([*self.record, f"{place},,\n"]).encode())
        self.archive.close()


def info_files(folder, tag):
    wheel = f"Wheel-Version: 1.0\nGenerator: scripts/python_wheel.py\nRoot-Is-Purelib: false\nTag: {tag}\n"
    return {f"{folder}/METADATA": metadata().encode(), f"{folder}/WHEEL": wheel.encode()}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    require_packages()
    build = finished_build(config_settings)
    info = f"bentaxis-{version()}.dist-info"
    with tempfile.TemporaryDirectory() as scratch:
        files = list(installed_files(build, pathlib.Path(scratch) / "prefix"))
        modules = [file.name for place, file in files if re.fullmatch(r"bentaxis/_bentaxis\..*\.so", place)]
        tag = tag_of(modules)
        name = f"bentaxis-{version()}-{tag}.whl"
        wheel = Wheel(pathlib.Path(wheel_directory) / name)
        for place, file in files:
            wheel.add(place, file.read_bytes(), 0o755 if os.access(file, os.X_OK) else 0o644)
        for place, content in info_files(info, tag).items():
            wheel.add(place, content)
        wheel.close(f"{info}/RECORD")
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    require_packages()
    folder = pathlib.Path(metadata_directory) / f"bentaxis-{version()}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(metadata())
    return folder.name


def source_files():
    """Of the repository those that git has; of an unpacked sdist all but what a build makes."""
    if (ROOT / ".git").exists():
        names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, check=True, text=True).stdout
        return sorted(name for name in names.split("\0") if name and (ROOT / name).is_file())
    made = re.compile(r"(build[^/]*|out|site|release)/|(.*/)?__pycache__/|PKG-INFO$")
    names = (str(path.relative_to(ROOT)) for path in ROOT.rglob("*") if path.is_file())
    return sorted(name for name in names if not made.match(name))


def build_sdist(sdist_directory, config_settings=None):
    base = f"bentaxis-{version()}"

    def add(archive, name, content, rights):
        entry = tarfile.TarInfo(f"{base}/{name}")
        entry.size, entry.mode = len(content), rights
        archive.addfile(entry, io.BytesIO(content))

    file = pathlib.Path(sdist_directory) / f"{base}.tar.gz"
    with open(file, "wb") as raw, gzip.GzipFile("", "wb", mtime=0, fileobj=raw) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        add(archive, "PKG-INFO", metadata().encode(), 0o644)
        for name in source_files():
            path = ROOT / name
            add(archive, name, path.read_bytes(), 0o755 if os.access(path, os.X_OK) else 0o644)
    return file.name
