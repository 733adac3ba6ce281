#include "tests/hand/simbody_assembler.h"

#include <Simbody.h>

#include "app/hand/hand_simbody.h"

namespace pregrasp {
namespace {

SimTK::Vec3 ToSimbody(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

struct SimbodyAssembler::Impl {
  explicit Impl(const HandModel& hand_in) : hand(hand_in), simbody(hand_in) {}

  HandModel hand;
  HandSimbody simbody;
};

SimbodyAssembler::SimbodyAssembler(const HandModel& hand) : impl_(std::make_unique<Impl>(hand)) {}
SimbodyAssembler::~SimbodyAssembler() = default;

HandConfiguration SimbodyAssembler::Solve(const std::vector<IkContact>& contacts,
                                          const HandConfiguration& start, double accuracy) {
  impl_->simbody.SetConfiguration(start);
  SimTK::State state = impl_->simbody.state();
  SimTK::Assembler assembler(impl_->simbody.system());
  for (int j = 0; j < kMaxHandJoints; ++j) {
    assembler.restrictQ(impl_->simbody.body(j + 1).getMobilizedBodyIndex(),
                        SimTK::MobilizerQIndex(0), impl_->hand.joints[j].lower,
                        impl_->hand.joints[j].upper);
  }
  auto* markers = new SimTK::Markers();  // owned by the assembler
  std::vector<SimTK::Markers::MarkerIx> order;
  for (const IkContact& contact : contacts) {
    const Fingertip& tip = impl_->hand.tip(contact.finger);
    order.push_back(markers->addMarker(FingerName(contact.finger),
                                       impl_->simbody.body(tip.link).getMobilizedBodyIndex(),
                                       ToSimbody(tip.p_LT), 1.0));
  }
  markers->defineObservationOrder(
      SimTK::Array_<SimTK::Markers::MarkerIx>(order.begin(), order.end()));
  assembler.adoptAssemblyGoal(markers);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double radius = impl_->hand.tip(contacts[i].finger).radius;
    markers->moveOneObservation(SimTK::Markers::ObservationIx(static_cast<int>(i)),
                                ToSimbody(contacts[i].p_WC + radius * contacts[i].nhat_W));
  }
  assembler.setAccuracy(accuracy);
  try {
    assembler.initialize(state);
    assembler.assemble();
  } catch (const SimTK::Exception::Base&) {
    // not assembled: what it reached stands
  }
  assembler.updateFromInternalState(state);
  impl_->simbody.system().realize(state, SimTK::Stage::Position);
  return impl_->simbody.GetConfiguration(state);
}

}  // namespace pregrasp
