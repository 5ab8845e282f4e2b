#include "sim/scene/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/material/grading.h"
#include "sim/scene/scenario_keys.h"

namespace scree {
namespace {

constexpr double kTick = 0.1;           // s of simulated time between looks at progress and rest
constexpr double kDepartureStep = 0.1;  // s between poses of a tool that leaves

}  // namespace

Stage::Stage(const Scenario& scenario, std::uint64_t seed, int threads, const RunHooks& hooks,
             const Vec3& domain_low, const Vec3& domain_high)
    : scenario_(scenario), model_(effective_model(scenario)), seed_(seed), hooks_(hooks) {
  WorldSettings settings;
  settings.material = model_.material;
  settings.contact_effects = model_.changes.contact;
  settings.flight_damping = model_.changes.flight_damping;
  settings.vibration = model_.changes.vibration;
  settings.breakage = model_.changes.breakage;
  if (!std::holds_alternative<DropTest>(scenario.experiment)) settings.clumps = model_.changes.clumps;
  if (scenario.engine == EngineKind::impulse) {
    settings.material.mu = scenario.bullet.value().friction;
    settings.material.mu_r = scenario.bullet.value().rolling;
    settings.smallest_diameter = model_.grading.min_diameter();
    settings.impulse_time_step = scenario.numerics.impulse_step_ratio *
                                 std::sqrt(settings.smallest_diameter / settings.gravity.norm());
    settings.impulse_iterations = scenario.numerics.impulse_iterations;
  }
  settings.domain_low = domain_low;
  settings.domain_high = domain_high;
  settings.time_step_safety = scenario.numerics.time_step_safety;
  settings.sleep = scenario.numerics.sleep;
  settings.wake_tolerance = scenario.numerics.wake_tolerance;
  settings.threads = threads;
  if (hooks_.resume != nullptr) {
    hooks_.resume->section("stage", 1);
    (*hooks_.resume)(saved_ticks_, observed_);
  }
  world_ =
      scenario.engine == EngineKind::rrlinear ? make_rrlinear_world(settings) : make_impulse_world(settings);
}

Surface Stage::surface(const std::optional<double>& mu, const std::optional<double>& mu_r) const {
  const Material& rock = scenario_.material;
  if (!scenario_.bullet) return {mu.value_or(rock.mu), mu_r.value_or(rock.mu_r)};
  // A surface keeps its ratio to the rock.
  const auto bullets = [](const std::optional<double>& own, double of_rock, double bullet) {
    return !own ? bullet : of_rock > 0 ? *own / of_rock * bullet : *own;
  };
  return {bullets(mu, rock.mu, scenario_.bullet->friction),
          bullets(mu_r, rock.mu_r, scenario_.bullet->rolling)};
}

Surface Stage::tool_surface(const std::optional<double>& mu, const std::optional<double>& mu_r) const {
  Surface tool = surface(mu, mu_r);
  tool.surface_energy = model_.changes.tool_surface_energy;
  return tool;
}

Surface Stage::ground_surface(const std::optional<double>& mu, const std::optional<double>& mu_r) const {
  Surface ground = surface(mu, mu_r);
  ground.mu *= model_.changes.ground_mu;
  ground.mu_r *= model_.changes.ground_mu_r;
  return ground;
}

TriangleMesh Stage::read(const std::filesystem::path& mesh, double scale) const {
  LoadedMesh loaded = load_mesh(mesh, scale);
  if (!loaded.report.errors.empty()) throw std::runtime_error(loaded.report.errors.front());
  return std::move(loaded.mesh);
}

void Stage::add_tools() {
  for (const ToolSpec& tool : scenario_.tools) {
    std::vector<Motion::Key> keys;
    for (const Keyframe& k : tool.keyframes) {
      const Vec3 r = k.rotation_deg * (std::numbers::pi / 180.0);
      Pose pose;
      pose.position = k.position;
      pose.rotation = Eigen::AngleAxisd(r.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(r.y(), Vec3::UnitY()) *
                      Eigen::AngleAxisd(r.x(), Vec3::UnitX());
      keys.push_back({k.time, pose});
    }
    for (std::size_t k = 1; k < tool.keyframes.size(); ++k) {
      const Keyframe &before = tool.keyframes[k - 1], &now = tool.keyframes[k];
      if (now.position != before.position || now.rotation_deg != before.rotation_deg)
        tools_end_ = std::max(tools_end_, now.time);
    }
    world_->add_mesh(read(tool.mesh, tool.scale), tool_surface(tool.mu, tool.mu_r), Motion(std::move(keys)));
  }
}

void Stage::begin(const std::vector<NewSphere>& fixed, const std::vector<std::vector<NewSphere>>& loads) {
  loads_ = loads;
  world_->add_spheres(fixed);
  outcome_.fixed = world_->fixed_balls();
  auto id = static_cast<std::int64_t>(fixed.size());
  for (const auto& load : loads_)
    for (const NewSphere& s : load) {
      const double mass = sphere_mass(model_.material, s.diameter);
      outcome_.original.push_back({id++, s.position, Vec3::Zero(), s.diameter, mass, s.dump});
    }
  world_->reserve_numbers(id);
  if (hooks_.begin) hooks_.begin(outcome_.original, outcome_.fixed);
}

void Stage::add_load(double lift) {
  auto& load = loads_.at(next_load_++);
  for (NewSphere& s : load) s.position.z() += lift;
  load_mass_ = 0;
  for (const NewSphere& s : load) load_mass_ += sphere_mass(model_.material, s.diameter);
  progress_.particles += static_cast<std::int64_t>(load.size());
  world_->add_spheres(load);
}

void Stage::push_load(const Vec3& velocity) {
  std::size_t first = outcome_.fixed.size();
  for (std::size_t k = 0; k + 1 < next_load_; ++k) first += loads_[k].size();
  for (std::size_t k = 0; k < loads_.at(next_load_ - 1).size(); ++k)
    world_->set_velocity(static_cast<std::int64_t>(first + k), velocity, Vec3::Zero());
}

bool Stage::leave_with_tool(const Departure& departure, double share_now, double share_then) {
  if (observe([&] { return world_->mass_of(departure.inside); }) == 0) return true;
  const double length = departure.way.norm(), start = world_->time();
  const double gathers = departure.speed / departure.acceleration;  // s, until it is at its speed
  std::vector<std::pair<double, double>> track{{0, 0}};             // s, m
  for (int k = 1; track.back().second < length; ++k) {
    const double t = k * kDepartureStep, ramp = std::min(t, gathers);
    const double passed = 0.5 * departure.acceleration * ramp * ramp + departure.speed * (t - ramp);
    track.emplace_back(t, std::min(passed, length));
  }
  std::vector<Motion::Key> keys;
  for (const auto& [t, passed] : track) {
    Pose pose = departure.pose;
    if (length > 0) pose.position += passed / length * departure.way;
    keys.push_back({start + t, pose});
  }
  world_->set_mesh_motion(departure.mesh, Motion(std::move(keys)));
  if (!advance(track.back().first, "leaving", share_now, share_then)) return false;
  if (!replaying())  // else it comes with the saved state
    outcome_.carried_back +=
        world_->take_out([&](const Vec3& place) { return departure.inside(place - departure.way); });
  return true;
}

double Stage::recall() {
  if (recalled_ == observed_.size()) throw StateError("saved state: it is of another run");
  return observed_[recalled_++];
}

template <class Stream>
void Stage::state(Stream& stream) {
  if constexpr (Stream::kReads)
    world_->load_state(stream);
  else
    world_->save_state(stream);
  stream.section("outcome", 2);
  double wall =
      wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  stream(outcome_.after_dumps, outcome_.carried_back, wall);
  if (Stream::kReads) wall_before_ = wall;
}

void Stage::save() {
  hooks_.save(world_->time(), [this](StateWriter& writer) {
    writer.section("stage", 1);
    writer(ticks_, observed_);
    state(writer);
  });
}

void Stage::take_up() {
  const double time = world_->time();
  state(*hooks_.resume);
  if (recalled_ != observed_.size() || world_->time() != time)
    throw StateError("saved state: it is of another run");
  if (hooks_.resumed) hooks_.resumed();
}

bool Stage::tick(double until, const char* stage, double share) {
  const double interval = scenario_.output.frame_interval;
  if (interval > 0 && hooks_.frame && world_->time() >= next_frame_ - 1e-9) {
    if (!replaying()) hooks_.frame(world_->snapshot(), world_->statistics().steps);
    next_frame_ += interval;
  }
  if (replaying()) {
    world_->skip_to(until);
    if (++ticks_ == saved_ticks_) take_up();
    return true;
  }
  ++ticks_;
  world_->advance_to(until);
  if (hooks_.look) hooks_.look(world_->snapshot());
  progress_.share = share;
  progress_.time = world_->time();
  progress_.stage = stage;
  progress_.particle_steps = world_->statistics().particle_steps;
  if (hooks_.progress && !hooks_.progress(progress_)) outcome_.interrupted = true;
  if (hooks_.save && world_->keeps_state() && hooks_.save_due()) save();
  return !outcome_.interrupted;
}

bool Stage::advance(double seconds, const char* stage, double share_now, double share_then) {
  const double start = world_->time(), end = start + seconds;
  while (world_->time() < end - 1e-9) {
    const double until = std::min(end, world_->time() + kTick);
    if (!tick(until, stage, share_now + (share_then - share_now) * (until - start) / seconds)) return false;
  }
  return true;
}

bool Stage::advance_to_rest(const char* stage, double share_now, double share_then) {
  const StopRule& stop = scenario_.stop;
  const double start = world_->time();
  bool has_moved = false;
  while (true) {
    const double passed = world_->time() - start;
    // The share is of the load's mass, so that a growing pile does not hide that a load still moves.
    progress_.moving_share = observe([&] {
      return load_mass_ > 0 ? world_->moving_mass_share(stop.speed) * world_->mass() / load_mass_ : 0.0;
    });
    const bool still = progress_.moving_share < stop.moving_mass_share;
    has_moved = has_moved || !still;
    // What has just been released is still: it has not come to rest.
    const double least = has_moved ? stop.min_time : std::max(stop.min_time, StopRule().min_time);
    if (still && passed >= std::min(least, stop.max_time)) return true;
    if (passed >= stop.max_time) {
      outcome_.at_rest = false;
      outcome_.notes.push_back(
          fmt::format("seed {}: {:.1f} % of the load still moved faster than {} m/s when stop.max_time_s = "
                      "{} s was reached",
                      seed_, 100 * progress_.moving_share, stop.speed, stop.max_time));
      return true;
    }
    // A load needs some 12 s; beyond that the estimate only creeps.
    const double share = share_now + (share_then - share_now) * (1.0 - std::exp(-passed / 6.0));
    if (!tick(world_->time() + kTick, stage, share)) return false;
  }
}

void Stage::dump_done(int dump, int dumps) {
  if (replaying()) return;  // kept piles come with the saved state
  const auto& asked = scenario_.output.after_dumps;
  if (dump < dumps && std::find(asked.begin(), asked.end(), dump) != asked.end())
    outcome_.after_dumps.push_back({dump, world_->snapshot()});
}

RunOutcome Stage::finish() {
  if (const double left = tools_end_ - world_->time(); !outcome_.interrupted && left > 1e-9)
    if (advance(left, "tools", 1, 1)) advance_to_rest("tools", 1, 1);
  if (replaying()) throw StateError("saved state: it is of another run");
  outcome_.final_state = world_->snapshot();
  if (hooks_.frame) hooks_.frame(outcome_.final_state, world_->statistics().steps);
  outcome_.statistics = world_->statistics();
  outcome_.energy = world_->energy_balance();
  outcome_.simulated_seconds = world_->time();
  outcome_.wall_seconds = wall_before_;
  if (model_.changes.breakage.on())
    note(fmt::format("seed {}: {} grains broke, fragments of fragments included", seed_,
                     outcome_.statistics.broken_spheres));
  return std::move(outcome_);
}

RunOutcome run_scenario(const Scenario& scenario, std::uint64_t seed, int threads, const RunHooks& hooks) {
  const auto start = std::chrono::steady_clock::now();
  RunOutcome outcome =
      std::visit(Overloaded{
                     [&](const EndDump& e) { return run_end_dump(scenario, e, seed, threads, hooks); },
                     [&](const ReposeLift& e) { return run_repose_lift(scenario, e, seed, threads, hooks); },
                     [&](const PushDump& e) { return run_push_dump(scenario, e, seed, threads, hooks); },
                     [&](const BucketDump& e) { return run_bucket_dump(scenario, e, seed, threads, hooks); },
                     [&](const DropTest& e) { return run_drop_test(scenario, e, seed, threads, hooks); },
                 },
                 scenario.experiment);
  outcome.wall_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace scree
