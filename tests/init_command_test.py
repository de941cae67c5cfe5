#!/usr/bin/env python3
"""Tests of `bentaxis init` from outside: what it writes, what it refuses, and that what it writes works.

usage: init_command_test.py BENTAXIS REPO_ROOT [options of unittest]      (Debian's python3, with yaml)
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

import yaml

import command_line_test as program
from command_line_test import INTERRUPTED, ProgramTest

GITHUB, GITLAB = ".github/workflows/bentaxis.yml", ".gitlab-ci.yml"
ALWAYS = {"case.toml", "README.md", ".gitignore", "reference/today/description.toml", "reference/today/analytic.csv",
          "reference/today/multibody.csv"}


class InitTest(ProgramTest):
    def made(self, name="project"):
        folder = self.folder / name
        return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}

    def project(self, *arguments):
        self.run_program("init", "project", *arguments)
        return self.folder / "project"

    def left(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_the_default_project_agrees_at_once(self):
        project = self.project()
        self.assertEqual(self.made(), ALWAYS | {GITHUB, GITLAB, "packages/README.md"})
        self.assertEqual(self.left(), ["project"])
        self.assertEqual((project / "case.toml").read_text(), (program.REPO / "cases" / "bap63_rated.toml").read_text())
        self.run_program("regress", "project/reference")

    def test_a_changed_pump_is_noticed_by_its_reference(self):
        project = self.project()
        case = project / "case.toml"
        text, count = re.subn(r"(?m)^tilt_deg = .*", "tilt_deg = 39", case.read_text())
        self.assertEqual(count, 1)
        case.write_text(text)
        self.run_program("regress", "project/reference", status=1)

    def test_job_files_as_they_are_chosen(self):
        for choice, files in (("github", {GITHUB}), ("gitlab", {GITLAB}), ("none", set())):
            with self.subTest(ci=choice):
                self.run_program("init", choice, "--ci", choice)
                self.assertEqual(self.made(choice) - {"packages/README.md"}, ALWAYS | files)
                # The README speaks of what is there.
                readme = (self.folder / choice / "README.md").read_text()
                for word in ("CI", "packages/", "BENTAXIS_PACKAGE"):
                    self.assertEqual(word in readme, bool(files), word)
        self.assert_mentions(self.refused("init", "other", "--ci", "jenkins"), "--ci", "jenkins", "github")

    def test_changes_are_written_into_the_case(self):
        project = self.project("--set", "pump.tilt_deg=35")
        self.assertIn("tilt_deg = 35", (project / "case.toml").read_text())
        self.run_program("regress", "project/reference")

    def test_curves_go_along(self):
        for name in ("bap63_load_step", "bap63_start_up"):
            with self.subTest(case=name):
                self.run_program("init", name, "--case", program.REPO / "cases" / f"{name}.toml")
                folder = self.folder / name
                curves = sorted((folder / "curves").iterdir())
                self.assertTrue(curves)
                for curve in curves:
                    self.assertEqual(curve.read_bytes(), (program.REPO / "cases" / "curves" / curve.name).read_bytes())
                moved = self.folder / "moved"
                folder.rename(moved)  # nothing in it says where it was made
                self.run_program("regress", "moved/reference")
                shutil.rmtree(moved)

    def test_two_curves_of_one_name(self):
        source = program.REPO / "cases"
        for place, name in (("a", "load_step_share.csv"), ("b", "start_up_motor.csv")):
            (self.folder / place).mkdir()
            shutil.copy(source / "curves" / name, self.folder / place / "curve.csv")
        text = (source / "bap63_load_step.toml").read_text()
        for old, new in (("curves/load_step_share.csv", "a/curve.csv"), ("curves/start_up_motor.csv", "b/curve.csv")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / "case.toml").write_text(text)
        project = self.project("--case", "case.toml")
        self.assertEqual({path.name for path in (project / "curves").iterdir()}, {"curve.csv", "2_curve.csv"})
        self.assertEqual({(project / "curves" / name).read_bytes() for name in ("curve.csv", "2_curve.csv")},
                         {(self.folder / place / "curve.csv").read_bytes() for place in "ab"})

    def test_refusals(self):
        (self.folder / "full").mkdir()
        (self.folder / "full" / "file").touch()
        (self.folder / "plain").touch()
        (self.folder / "link").symlink_to(self.folder / "full")
        bad = self.case("bad.toml", **{"pump.tilt_deg": 95})
        for arguments, words in ((("full",), ("full", "not empty")), (("plain",), ("plain", "not a directory")),
                                 (("link",), ("link",)), (("none/below",), ("none", "does not exist")), (("",), ("must not be empty",)),
                                 (("new", "--case", bad), ("bad.toml", "tilt_deg", "95")),
                                 (("new", "--case", "missing.toml"), ("missing.toml",)),
                                 (("new", "--set", "pump.tilt=3"), ("pump.tilt", "tilt_deg"))):
            with self.subTest(arguments=arguments):
                self.assert_mentions(self.refused("init", *arguments), *words)

    def test_an_empty_folder_is_filled(self):
        (self.folder / "project").mkdir()
        number = (self.folder / "project").stat().st_ino
        self.project("--ci", "none")
        self.assertEqual((self.folder / "project").stat().st_ino, number)
        self.assertEqual(self.made(), ALWAYS)

    def test_the_folder_one_stands_in(self):
        here = self.folder / "here"
        here.mkdir()
        done = subprocess.run([program.PROGRAM, "init", ".", "--ci", "none"], cwd=here, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.made("here"), ALWAYS)
        self.assertEqual(self.left(), ["here"])

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_a_parent_that_cannot_be_written(self):
        (self.folder / "closed").mkdir(mode=0o500)
        self.assert_mentions(self.refused("init", "closed/new"), "closed")

    def test_an_interruption_leaves_nothing(self):
        process = self.start("init", "project", "--case", program.REPO / "cases" / "bap63_peak_hydraulic.toml")
        for _ in range(500):
            if self.left():
                break
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        process.communicate()
        self.assertIn(process.returncode, (INTERRUPTED, 0))
        self.assertEqual(self.left(), [] if process.returncode else ["project"])

    def jobs(self, project):
        """The commands of both job files but the installation, and what they keep."""
        github = yaml.safe_load((project / GITHUB).read_text())
        steps = github["jobs"]["regress"]["steps"]
        of_github = [step["run"] for step in steps if "run" in step and step["name"] != "install"]
        self.assertTrue(all(step.get("if") == "always()" for step in steps if step["name" if "name" in step else "uses"] == "keep"))
        gitlab = yaml.safe_load((project / GITLAB).read_text())["regress"]
        self.assertEqual(gitlab["artifacts"]["when"], "always")
        self.assertEqual(gitlab["artifacts"]["reports"]["junit"], "results/junit.xml")
        return of_github, gitlab["script"]

    def test_job_files_do_what_they_say(self):
        project = self.project()
        of_github, of_gitlab = self.jobs(project)
        self.assertEqual(of_github, [command.partition(" ||")[0] for command in of_gitlab[:-1]])
        path = f"{pathlib.Path(program.PROGRAM).parent}:{os.environ['PATH']}"
        for command in of_github:
            subprocess.run(["bash", "-ec", command], cwd=project, env={**os.environ, "PATH": path}, check=True,
                           capture_output=True)
        for name in ("junit.xml", "regress.html", "report.html", "report.json"):
            self.assertTrue((project / "results" / name).is_file(), name)

    def test_both_commands_run_and_either_fails_the_job(self):
        project = self.project()
        of_github, of_gitlab = self.jobs(project)
        said = self.folder / "said"
        (self.folder / "bin").mkdir()
        stand_in = self.folder / "bin" / "bentaxis"
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        for regress, compare in ((0, 0), (1, 0), (0, 1), (1, 2), (2, 1), (3, 0)):
            stand_in.write_text(f'#!/bin/sh\necho "$1" >> {said}\n[ "$1" = regress ] && exit {regress}\nexit {compare}\n')
            stand_in.chmod(0o755)
            environment = {**os.environ, "PATH": path}
            with self.subTest(regress=regress, compare=compare):
                # GitLab: one script of all lines, which ends where one fails.
                said.unlink(missing_ok=True)
                done = subprocess.run(["bash", "-c", "set -eo pipefail\n" + "\n".join(of_gitlab)], cwd=project, env=environment)
                self.assertEqual(said.read_text().split(), ["regress", "compare"])
                self.assertEqual(done.returncode, regress or compare)
                # GitHub: a script per step; the job fails where a step does.
                said.unlink(missing_ok=True)
                codes = [subprocess.run(["sh", "-ec", command], cwd=project, env=environment).returncode for command in of_github]
                self.assertEqual((said.read_text().split(), codes), (["regress", "compare"], [regress, compare]))
        steps = yaml.safe_load((project / GITHUB).read_text())["jobs"]["regress"]["steps"]
        condition = next(step["if"] for step in steps if step.get("name") == "compare")
        self.assertEqual(condition, "${{ !cancelled() && steps.install.outcome == 'success' }}")
        self.assertEqual(next(step["id"] for step in steps if step.get("name") == "install"), "install")

    def test_the_package_that_is_installed(self):
        project = self.project()
        (project / "packages" / "bentaxis_1.1.0_amd64.deb").touch()
        other = self.folder / "other.deb"
        other.touch()
        said = self.folder / "said"
        (self.folder / "bin").mkdir()
        apt = self.folder / "bin" / "apt-get"
        apt.write_text(f'#!/bin/sh\necho "$@" >> {said}\n')
        apt.chmod(0o755)
        github = yaml.safe_load((project / GITHUB).read_text())
        install = [step["run"] for step in github["jobs"]["regress"]["steps"] if step.get("name") == "install"]
        gitlab = yaml.safe_load((project / GITLAB).read_text())["regress"]["before_script"]
        for commands in (install, ["\n".join(gitlab)]):
            for variable, package in (("", project / "packages" / "bentaxis_1.1.0_amd64.deb"), (str(other), other)):
                said.unlink(missing_ok=True)
                environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", "BENTAXIS_PACKAGE": variable}
                subprocess.run(["bash", "-ec", commands[0]], cwd=project, env=environment, check=True)
                self.assertTrue(said.read_text().rstrip().endswith(f" {package.resolve()}"), said.read_text())

    def test_the_documented_job_files_are_these(self):
        project = self.project()
        page = (program.REPO / "docs" / "ci.md").read_text()
        blocks = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
        self.assertEqual(blocks, [(project / GITHUB).read_text(), (project / GITLAB).read_text()])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
