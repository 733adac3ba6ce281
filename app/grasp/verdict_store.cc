#include "app/grasp/verdict_store.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/core/json_values.h"
#include "app/core/sha256.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

// Numbers and words, each followed by a blank: the text that the key is the hash of.
class KeyText {
 public:
  KeyText& operator<<(const char* word) {
    text_ += word;
    text_ += ' ';
    return *this;
  }
  KeyText& operator<<(double value) { return *this << FormatDouble(value).c_str(); }
  template <typename Derived>
  KeyText& operator<<(const Eigen::MatrixBase<Derived>& matrix) {
    for (int i = 0; i < matrix.rows(); ++i) {
      for (int j = 0; j < matrix.cols(); ++j) *this << static_cast<double>(matrix(i, j));
    }
    return *this;
  }
  KeyText& operator<<(const RigidTransform& X) { return *this << X.translation() << X.linear(); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct ShapeText {
  KeyText& out;

  void operator()(const Box& box) const { out << "box" << box.size; }
  void operator()(const Cylinder& c) const { out << "cylinder" << c.radius << c.height; }
  void operator()(const Capsule& c) const { out << "capsule" << c.radius << c.height; }
  void operator()(const Sphere& sphere) const { out << "sphere" << sphere.radius; }
  void operator()(const Mesh& mesh) const { out << "mesh" << mesh.mesh.V << mesh.mesh.F; }
  void operator()(const Cloud& cloud) const { out << "mesh" << cloud.mesh.V << cloud.mesh.F; }
  void operator()(const Union& whole) const {
    out << "union" << static_cast<double>(whole.parts.size());
    for (const PlacedShape& part : whole.parts) {
      out << part.X_BP;
      std::visit(ShapeText{out}, part.shape);
    }
  }
};

void AddScene(const Scene& scene, KeyText& out) {
  const MassProperties& object = *scene.object().mass_properties;
  out << object.mass << object.p_BoBcm << scene.gravity << scene.fingertips.friction
      << scene.fingertips.max_force;
  for (const Body& body : scene.bodies) {
    out << body.X_WB;
    std::visit(ShapeText{out}, body.shape);
  }
}

void AddHand(const HandModel& hand, KeyText& out) {
  for (int j = 0; j < hand.num_joints; ++j) {
    const HandJoint& joint = hand.joints[j];
    out << static_cast<double>(joint.parent) << joint.X_PJ << joint.axis << joint.lower
        << joint.upper;
  }
  for (const HandCapsule& capsule : hand.capsules) {
    out << static_cast<double>(capsule.link) << capsule.p_LA << capsule.p_LB << capsule.radius;
  }
  for (int f = 0; f < hand.num_fingers; ++f) {
    const Fingertip& tip = hand.tips[f];
    out << static_cast<double>(tip.link) << tip.p_LT << tip.radius;
  }
  for (const auto& [a, b] : hand.self_pairs)
    out << static_cast<double>(a) << static_cast<double>(b);
}

void AddConfig(const SurfacePointsConfig& surface, const StartCertificateConfig& config,
               KeyText& out) {
  const GraspSearchConfig& search = config.search;
  const SamplerConfig& sampler = search.sampler;
  const IkConfig& ik = search.grasp.kinematics.ik;
  out << surface.spacing << surface.max_points << search.grasp.f_min << search.max_sets
      << search.max_plausible << search.max_solves << search.max_found
      << search.grasp.kinematics.reach_starts << sampler.near_spacing << sampler.near_offset
      << sampler.near_share << sampler.opposed_share << sampler.slack.object
      << sampler.slack.environment << std::to_string(config.seed).c_str() << ik.tip_tolerance
      << ik.tip_target << ik.max_cone_deg << ik.min_clearance << ik.contact_depth << ik.certify
      << ik.max_starts << ik.start_candidates << ik.max_iterations << ik.slsqp
      << ik.slsqp_evaluations << ik.clearance_buffer << ik.influence << ik.warm_starts;
}

Vector3 ToVector3(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

// JSON has no infinity; null stands for it.
Json FiniteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double ToDouble(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

Json DescribeGrasp(const GraspResult& grasp) {
  Json contacts = Json::array();
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const GraspContact& contact = grasp.contacts[i];
    contacts.push_back({{"finger", static_cast<int>(contact.finger)},
                        {"p_OC", ToJson(contact.p_OC)},
                        {"nhat_O", ToJson(contact.nhat_O)},
                        {"on_edge", contact.on_edge},
                        {"f_O", ToJson(Vector3(grasp.wrench->forces.row(static_cast<int>(i))))}});
  }
  const IkResult& ik = grasp.kinematics->ik;
  const Matrix3& R_WH = ik.X_WH.linear();
  return {{"contacts", contacts},
          {"margin", grasp.wrench->margin},
          {"p_WH", ToJson(Vector3(ik.X_WH.translation()))},
          {"R_WH", ToJson(R_WH)},
          {"q", std::vector<double>(ik.q.data(), ik.q.data() + ik.q.size())}};
}

GraspResult ToGrasp(const Json& json) {
  GraspResult grasp;
  grasp.status = GraspStatus::kFeasible;
  WrenchResult wrench;
  wrench.status = WrenchStatus::kFeasible;
  wrench.margin = json.at("margin").get<double>();
  wrench.closed = wrench.margin > 0.0;
  wrench.min_normal = std::numeric_limits<double>::infinity();
  const Json& contacts = json.at("contacts");
  wrench.forces.resize(static_cast<int>(contacts.size()), 3);
  int row = 0;
  for (const Json& contact : contacts) {
    const int finger = contact.at("finger").get<int>();
    if (finger < 0 || finger >= kNumFingers) throw std::out_of_range("finger");
    grasp.contacts.push_back({static_cast<Finger>(finger), ToVector3(contact.at("p_OC")),
                              ToVector3(contact.at("nhat_O")), contact.at("on_edge").get<bool>()});
    const Vector3 f = ToVector3(contact.at("f_O"));
    wrench.min_normal = std::min(wrench.min_normal, -f.dot(grasp.contacts.back().nhat_O));
    wrench.forces.row(row++) = f;
  }
  KinematicResult kinematics;
  kinematics.status = KinematicStatus::kFeasible;
  kinematics.ik.status = IkStatus::kSolved;
  Matrix3 R_WH;
  for (int i = 0; i < 3; ++i) R_WH.row(i) = ToVector3(json.at("R_WH").at(i));
  kinematics.ik.X_WH = MakeTransform(R_WH, ToVector3(json.at("p_WH")));
  for (int i = 0; i < kMaxHandJoints; ++i) kinematics.ik.q[i] = json.at("q").at(i).get<double>();
  grasp.wrench = wrench;
  grasp.kinematics = kinematics;
  return grasp;
}

Json DescribeCertificate(const StartCertificate& certificate) {
  const BalanceProof& proof = certificate.proof;
  const GraspSearchStats& search = certificate.search;
  Json json = {
      {"verdict", static_cast<int>(certificate.verdict)},
      {"mu", certificate.mu},
      {"mu_star", FiniteOrNull(certificate.mu_star)},
      {"proof",
       {{"impossible", proof.impossible},
        {"direction", std::vector<double>(proof.direction.data(), proof.direction.data() + 6)},
        {"slack", proof.slack},
        {"covered", FiniteOrNull(proof.covered)}}},
      {"proof_slack", certificate.proof_slack},
      {"surface_points", certificate.surface_points},
      {"reachable_points", certificate.reachable_points},
      {"edge_points", certificate.edge_points},
      {"reachable_edge_points", certificate.reachable_edge_points},
      {"spacing", certificate.spacing},
      {"proposed", {certificate.proposed_nodes, certificate.proposed_samples}},
      {"search",
       {search.drawn, search.plausible, search.on_edges, search.held, search.solved, search.reached,
        search.feasible, search.tried}}};
  if (certificate.example) json["example"] = DescribeGrasp(*certificate.example);
  return json;
}

StartCertificate ToCertificate(const Json& json) {
  StartCertificate certificate;
  const int verdict = json.at("verdict").get<int>();
  if (verdict < 0 || verdict > static_cast<int>(StartVerdict::kGraspable)) {
    throw std::out_of_range("verdict");
  }
  certificate.verdict = static_cast<StartVerdict>(verdict);
  certificate.mu = json.at("mu").get<double>();
  certificate.mu_star = ToDouble(json.at("mu_star"));
  const Json& proof = json.at("proof");
  certificate.proof.impossible = proof.at("impossible").get<bool>();
  for (int i = 0; i < 6; ++i) {
    certificate.proof.direction[i] = proof.at("direction").at(i).get<double>();
  }
  certificate.proof.slack = proof.at("slack").get<double>();
  certificate.proof.covered = ToDouble(proof.at("covered"));
  certificate.proof_slack = json.at("proof_slack").get<double>();
  certificate.surface_points = json.at("surface_points").get<int>();
  certificate.reachable_points = json.at("reachable_points").get<int>();
  certificate.edge_points = json.at("edge_points").get<int>();
  certificate.reachable_edge_points = json.at("reachable_edge_points").get<int>();
  certificate.spacing = json.at("spacing").get<double>();
  certificate.proposed_nodes = json.at("proposed").at(0).get<int>();
  certificate.proposed_samples = json.at("proposed").at(1).get<int>();
  const Json& search = json.at("search");
  GraspSearchStats& stats = certificate.search;
  int i = 0;
  for (int* count : {&stats.drawn, &stats.plausible, &stats.on_edges, &stats.held, &stats.solved,
                     &stats.reached, &stats.feasible, &stats.tried}) {
    *count = search.at(i++).get<int>();
  }
  if (json.contains("example")) certificate.example = ToGrasp(json.at("example"));
  return certificate;
}

}  // namespace

std::string StartVerdictKey(const Scene& scene, const HandModel& hand,
                            const SurfacePointsConfig& surface,
                            const StartCertificateConfig& config, const GraspProposer& proposer) {
  KeyText out;
  out << "start" << Sha256OfProgram().c_str();
  AddScene(scene, out);
  AddHand(hand, out);
  AddConfig(surface, config, out);
  out << proposer.key.c_str();
  return Sha256(out.text());
}

std::filesystem::path DefaultVerdictFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/') {
    return std::filesystem::path(cache) / "pregrasp" / "verdicts";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return std::filesystem::path(home) / ".cache" / "pregrasp" / "verdicts";
  }
  return {};
}

std::optional<StartCertificate> LoadStartVerdict(const std::filesystem::path& folder,
                                                 const std::string& key) {
  std::ifstream in(folder / (key + ".json"));
  if (!in) return std::nullopt;
  std::stringstream text;
  text << in.rdbuf();
  try {
    const Json file = Json::parse(text.str());
    const Json& body = file.at("start");
    const bool whole = file.at("key") == key && file.at("sha256") == Sha256(body.dump());
    if (!whole) return std::nullopt;
    return ToCertificate(body);
  } catch (const std::exception&) {  // whatever is wrong with it, it is not a verdict
    return std::nullopt;
  }
}

bool StoreStartVerdict(const std::filesystem::path& folder, const std::string& key,
                       const StartCertificate& certificate) {
  const Json body = DescribeCertificate(certificate);
  const Json file = {{"key", key}, {"sha256", Sha256(body.dump())}, {"start", body}};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path target = folder / (key + ".json");
  std::string name = (folder / (key + ".XXXXXX")).string();
  const int descriptor = mkstemp(name.data());  // a name no other writer has
  if (descriptor < 0) return false;
  const std::string text = file.dump(1) + "\n";
  const ssize_t size = static_cast<ssize_t>(text.size());
  bool written = write(descriptor, text.data(), text.size()) == size;
  written = close(descriptor) == 0 && written;
  if (written) std::filesystem::rename(name, target, error);
  if (!written || error) {
    std::filesystem::remove(name, error);
    return false;
  }
  return true;
}

StartCertificate FindStartVerdict(const GraspWorld& world, const StartCertificateConfig& config,
                                  const GraspProposer& proposer,
                                  const std::vector<std::filesystem::path>& folders,
                                  ThreadPool& pool,
                                  const std::function<void(const GraspSearchStats&)>& progress) {
  const std::string key =
      StartVerdictKey(world.scene(), world.ik().hand(), world.surface_config(), config, proposer);
  for (const std::filesystem::path& folder : folders) {
    if (std::optional<StartCertificate> known = LoadStartVerdict(folder, key)) return *known;
  }
  StartCertificate certificate = CertifyStart(world, config, proposer, pool, progress);
  if (!folders.empty() && !folders.back().empty()) {
    StoreStartVerdict(folders.back(), key, certificate);
  }
  return certificate;
}

}  // namespace pregrasp
