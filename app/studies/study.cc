#include "app/studies/study.h"

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {

// Each in the file of its name.
StudyInfo Table1Study();
StudyInfo LadderStudy();
StudyInfo LearningStudy();
StudyInfo IkOrderStudy();

const std::vector<StudyInfo>& Studies() {
  static const std::vector<StudyInfo> studies = {Table1Study(), LadderStudy(), LearningStudy(),
                                                 IkOrderStudy()};
  return studies;
}

const StudyInfo& FindStudy(const std::string& name) {
  std::vector<std::string> names;
  std::string all;
  for (const StudyInfo& study : Studies()) {
    if (study.name == name) return study;
    names.push_back(study.name);
    all += (all.empty() ? "" : ", ") + study.name;
  }
  throw InputError("--study", "", all, '"' + name + '"' + FormatHint(FindNearest(name, names)));
}

}  // namespace pregrasp
