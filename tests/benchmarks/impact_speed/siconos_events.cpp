#include "tests/benchmarks/impact_speed/siconos_events.hpp"

#include <SiconosKernel.hpp>
#include <cmath>
#include <memory>

namespace peers {
namespace {

// Its functions of time have no room for parameters of their own.
double load_now = 0, shaking_now = 0;

void load(double t, unsigned int size, double* into, unsigned int, double*) {
  std::fill(into, into + size, 0);
  into[0] = load_now + shaking_now * shaking_now * std::sin(shaking_now * t);
}

}  // namespace

Times by_siconos(const SiconosScene& scene, double tolerance, double step) {
  load_now = scene.load;
  shaking_now = scene.shaking;
  auto q = std::make_shared<SiconosVector>(1, scene.q), v = std::make_shared<SiconosVector>(1, scene.v);
  auto mass = std::make_shared<SimpleMatrix>(1, 1);
  (*mass)(0, 0) = 1;
  auto point = std::make_shared<LagrangianLinearTIDS>(q, v, mass);
  point->setComputeFExtFunction(load);
  auto model = std::make_shared<NonSmoothDynamicalSystem>(scene.begin, scene.end);
  model->insertDynamicalSystem(point);
  auto law = std::make_shared<NewtonImpactNSL>(scene.restitution);
  for (const auto& [h, b] : scene.walls) {
    auto H = std::make_shared<SimpleMatrix>(1, 1);
    (*H)(0, 0) = h;
    auto relation = std::make_shared<LagrangianLinearTIR>(H, std::make_shared<SiconosVector>(1, b));
    model->link(std::make_shared<Interaction>(law, relation), point);
  }
  return times_of_impacts(model, scene.begin, tolerance, step);
}

Times times_of_impacts(const std::shared_ptr<NonSmoothDynamicalSystem>& model, double begin, double tolerance,
                       double step) {
  auto integrator = std::make_shared<LsodarOSI>();
  auto simulation = std::make_shared<EventDriven>(model, std::make_shared<TimeDiscretisation>(begin, step));
  simulation->insertIntegrator(integrator);
  simulation->insertNonSmoothProblem(std::make_shared<LCP>(), SICONOS_OSNSP_ED_IMPACT);
  simulation->insertNonSmoothProblem(std::make_shared<LCP>(), SICONOS_OSNSP_ED_SMOOTH_ACC);
  simulation->setPrintStat(false);
  simulation->initialize();
  integrator->setTol(1, tolerance, tolerance);
  Times times;
  const auto events = simulation->eventsManager();
  try {
    while (simulation->hasNextEvent()) {
      simulation->advanceToEvent();
      if (events->nextEvent()->getType() == NS_EVENT)
        times.push_back(events->nextEvent()->getDoubleTimeOfEvent());
      simulation->processEvents();
    }
  } catch (...) {  // it stops where a gap is below its own tolerance; the impacts until then count
  }
  return times;
}

}  // namespace peers
