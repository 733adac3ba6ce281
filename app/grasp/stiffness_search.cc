#include "app/grasp/stiffness_search.h"

#include <algorithm>

namespace pregrasp {
namespace {

constexpr std::size_t kPromising = 64;  // moves whose least eigenvalue is computed
constexpr int kTried = 3;               // of those that hold, put to the choice of forces
constexpr double kSameFace = 0.99;      // cosine between normals that the same force suits

}  // namespace

StiffnessSearch::StiffnessSearch(const GraspWorld& world, const GraspConfig& config,
                                 const GraspForcesConfig& forces,
                                 const std::vector<ContactChoices>& choices, const Matrix3& R_WO,
                                 int max_tests)
    : world_(world),
      config_(config),
      forces_(forces),
      choices_(choices),
      R_WO_(R_WO),
      wrench_(world.MakeWrenchConfig(config.f_min, R_WO)),
      k_(world.scene().fingertips.grasp_stiffness),
      tests_left_(max_tests) {}

std::optional<GraspForces> StiffnessSearch::Choose(const ContactChoice& choice) {
  if (tests_left_ <= 0) return std::nullopt;
  --tests_left_;
  return ChooseGraspForces(world_.ToWrenchContacts(ToContacts(choices_, choice)), wrench_, k_,
                           forces_);
}

bool StiffnessSearch::IsStiff(const ContactChoice& choice) {
  const std::optional<GraspForces> forces = Choose(choice);
  return forces && forces->is_stiff;
}

bool StiffnessSearch::Run(ContactChoice& choice) {
  ContactChoice best = choice;
  std::optional<GraspForces> forces = Choose(best);
  while (forces && !forces->is_stiff) {
    std::optional<GraspForces> better;
    int tried = 0;
    for (const Move& move : FindMoves(best, *forces)) {
      if (tried == kTried) break;
      if (!HasRoom(world_.tips(), choices_, best, move.contact, move.place)) continue;
      ContactChoice moved = best;
      moved[move.contact] = move.place;
      if (CalcForceStatus(world_, config_, ToContacts(choices_, moved), R_WO_) !=
          GraspStatus::kFeasible) {
        continue;
      }
      ++tried;
      std::optional<GraspForces> found = Choose(moved);
      if (!found || !(found->least.value > forces->least.value)) continue;
      best = std::move(moved);
      better = std::move(found);
      break;
    }
    forces = std::move(better);
  }
  if (!forces) return false;
  choice = best;
  return true;
}

// The moves that are expected to leave the least stiffness largest, at forces that stay what they
// are, the largest first.
std::vector<StiffnessSearch::Move> StiffnessSearch::FindMoves(const ContactChoice& choice,
                                                              const GraspForces& forces) const {
  const std::vector<WrenchContact> contacts = world_.ToWrenchContacts(ToContacts(choices_, choice));
  const Matrix6 K = CalcGraspStiffness(contacts, forces.forces, k_);
  Vector6 motion;
  motion << forces.least.shift, forces.least.turn / forces_.turn_length;
  struct Candidate {
    Move move;
    Matrix6 K;
  };
  std::vector<Candidate> candidates;
  std::size_t row = 0;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const bool left_out = choice[i] == kLeftOut;
    const std::size_t at = left_out ? 0 : row++;
    if (choices_[i].places.size() < 2) continue;  // fixed
    Matrix6 others = K;
    Vector3 f_old = Vector3::Zero(), nhat_old = Vector3::Zero();
    if (!left_out) {
      f_old = forces.forces.row(static_cast<Eigen::Index>(at));
      nhat_old = choices_[i].places[choice[i]].nhat_O;
      others -= CalcGraspStiffness({&contacts[at], 1}, f_old.transpose(), k_);
    }
    const std::vector<WrenchContact> places = world_.ToWrenchContacts(choices_[i].places);
    for (int place = 0; place < static_cast<int>(choices_[i].places.size()); ++place) {
      if (place == choice[i]) continue;
      const Vector3& nhat = choices_[i].places[place].nhat_O;
      const double normal = left_out ? wrench_.f_min : -f_old.dot(nhat_old);
      const bool same_face = !left_out && nhat.dot(nhat_old) > kSameFace;
      Move move{static_cast<int>(i), place, 0.0};
      const Vector3 f = same_face ? f_old : Vector3(-normal * nhat);
      const Matrix6 K_moved = others + CalcGraspStiffness({&places[place], 1}, f.transpose(), k_);
      move.stiffness = motion.dot(K_moved * motion);
      candidates.push_back({move, K_moved});
    }
  }
  const auto stiffer = [](const Candidate& a, const Candidate& b) {
    return a.move.stiffness > b.move.stiffness;
  };
  std::stable_sort(candidates.begin(), candidates.end(), stiffer);
  candidates.resize(std::min(candidates.size(), kPromising));
  for (Candidate& candidate : candidates) {
    candidate.move.stiffness = FindLeastStiffness(candidate.K, forces_.turn_length).value;
  }
  std::stable_sort(candidates.begin(), candidates.end(), stiffer);
  std::vector<Move> moves;
  for (const Candidate& candidate : candidates) moves.push_back(candidate.move);
  return moves;
}

}  // namespace pregrasp
