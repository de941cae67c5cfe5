#include "bentaxis/study/project.h"

#include <algorithm>
#include <string>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/files/new_folder.h"
#include "bentaxis/study/reference_maker.h"
#include "project_texts.h"

namespace bentaxis::study {
namespace fs = std::filesystem;

std::vector<fs::path> make_project(const Case& the_case, bool changed, const ProjectCi& ci,
                                   const fs::path& folder, const PartProgress& progress_of) {
  NewFolder project(folder);
  const KeptCase kept = kept_case(the_case);
  // Without curves the file itself will do, with all that people wrote into it.
  project.add("case.toml", changed || !kept.curves.empty() ? kept.text : bytes_of(the_case.file));
  for (const KeptCase::Curve& curve : kept.curves) project.add(curve.name, curve.bytes);
  const bool any_ci = ci.github || ci.gitlab;
  project.add("README.md", std::string(project_text("README.md")) +
                               (any_ci ? project_text("readme_ci.md") : ""));
  project.add(".gitignore", project_text("gitignore"));
  if (ci.github) project.add(".github/workflows/bentaxis.yml", project_text("github.yml"));
  if (ci.gitlab) project.add(".gitlab-ci.yml", project_text("gitlab.yml"));
  if (any_ci)
    project.add(
        "packages/README.md",
        "The Debian package of bentaxis for CI, bentaxis_VERSION_amd64.deb, belongs here.\n");
  make_golden(read_case(project.here() / "case.toml"), false, kGoldenSamples,
              project.here() / "reference" / "today", progress_of);
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(project.here()))
    if (entry.is_regular_file())
      files.push_back(folder / fs::relative(entry.path(), project.here()));
  std::sort(files.begin(), files.end());
  project.commit();
  return files;
}

}  // namespace bentaxis::study
