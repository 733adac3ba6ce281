#include "app/studies/study.h"

#include "app/core/error.h"

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
  std::string names;
  for (const StudyInfo& study : Studies()) {
    if (study.name == name) return study;
    names += (names.empty() ? "" : ", ") + study.name;
  }
  throw InputError("--study", "", names, '"' + name + '"');
}

}  // namespace pregrasp
