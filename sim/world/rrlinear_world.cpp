#include "sim/world/rrlinear_world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr int kChecksToEnergy = 5;       // checks of the state after which energy is checked, too
constexpr int kStepsBetweenChecks = 20;  // of the stable step, of lost and runaway spheres
// Listings per sphere after which neighbours in space are made neighbours in memory again.
constexpr std::int64_t kListingsBetweenSorts = 25;
constexpr double kSkinHorizon = 30.0;  // steps that a sphere's skin should last
constexpr double kToolSkin =
    0.5;  // of the smallest radius: how far a tool moves before facets are listed anew
constexpr double kToolTravel = 0.25;  // of the smallest radius: most that a tool may travel in one step
constexpr double kNearGap =
    0.05;  // of the smaller radius: gap below which a contact is expected (stable step)
constexpr double kMostTravel = 0.2;    // of the radius: most that a sphere may travel in one step
constexpr double kLargestStep = 0.05;  // s; for scenes with nothing stiff in them

// A dashpot sees the velocity half a step late. With the share beta of critical damping leapfrog is stable up
// to w dt = 2 (sqrt(1 + beta^2) - beta), without it up to 2; and it may take some two thirds of the speed in
// one step, else it turns it round. Squares of steps, s2.
double with_dashpot(double step2, double beta) {
  const double stable = std::sqrt(1 + beta * beta) - beta;
  const double shorter = beta > 0 ? std::min(stable, 0.3 / beta) : 1;
  return step2 * shorter * shorter;
}

}  // namespace

RrlinearWorld::RrlinearWorld(const WorldSettings& settings)
    : RockWorld(settings),
      law_(settings.material, settings.contact_effects),
      team_(settings.threads),
      sleep_(settings.sleep && !settings.vibration.on(), settings.wake_tolerance) {
  pairs_.set_team(&team_);
}

std::unique_ptr<RockWorld> make_rrlinear_world(const WorldSettings& settings) {
  return std::make_unique<RrlinearWorld>(settings);
}

// Runs body(work) over the blocks; one thread goes from the last to the first.
template <class Body>
void RrlinearWorld::for_blocks(Body&& body) {
  const int last = static_cast<int>(blocks_.size()) - 1;
  team_.run(last + 1, [&](int k) { body(blocks_[last - k]); });
}

double RrlinearWorld::horizon() const {
  return kSkinHorizon * dt_;
}

int RrlinearWorld::stepSimulation(btScalar span, int, btScalar) {
  const auto before = statistics_.steps;
  advance_to(time_ + span);
  update_bullet();
  return static_cast<int>(statistics_.steps - before);
}

void RrlinearWorld::sphere_pushed(int index) {
  energy_watch_.restart();
  disturbed_.assign(1, index);
  wake(disturbed_);
}

void RrlinearWorld::sphere_lost(int index) {
  energy_watch_.restart();
  if (!changed_) {  // those that lay on it
    std::vector<int> left_alone;
    for (const Neighbour& n : pairs_.neighbours(index))
      if (n.touching() && n.sphere < spheres_.movable && !spheres_.lost[n.sphere])
        left_alone.push_back(n.sphere);
    wake(left_alone);
    for (const Neighbour& n : pairs_.neighbours(index))
      if (!spheres_.lost[n.sphere] && n.touching()) account_.lost_other += held_by(index, n);
    for (const MeshContact& c : mesh_contacts(index)) account_.lost_other += held_by(c, index);
  }
  pairs_.drop(index);
  sleep_.lose(index, spheres_);
  repair_due_ = true;
  blocks_due_ = true;
}

// What its contacts hold goes with it; of spheres that have left it went with them.
void RrlinearWorld::mesh_leaves(int index) {
  for (int i = 0; i < facets_.rows(); ++i) {
    if (spheres_.lost[i]) continue;
    for (int k = 0; k < facets_.count(i); ++k)
      if (const MeshContact& c = facets_.contact(i, k); c.body == index) account_.tools -= held_by(c, i);
  }
}

void RrlinearWorld::advance_to(double end) {
  if (changed_) prepare();
  while (time_ < end) {
    if (changed_ || pairs_.listings() > kListingsBetweenSorts * spheres_.movable) prepare();
    if (--steps_to_check_ < 0) {
      steps_to_check_ = kStepsBetweenChecks - 1;
      check_spheres(sleep_.awake());
      if (repair_due_) repair();
      if (!growing_.empty()) {
        before_fragments_ = energy_by_places();
        grow_fragments();
        prepare();
      }
      if (--checks_to_energy_ <= 0) check_energy();
      sleep_.look(spheres_, sum_, pairs_, watched_, law_, time_, settings_.gravity);
      for (const int i : sleep_.fallen_asleep()) {
        energy_watch_.take_asleep(potential_energy(i));
        blocks_due_ = true;
      }
      account_.put_to_sleep += sleep_.put_to_sleep();
      dt_ = stable_step();
    }
    // The last step is cut to end on time; a remainder below a millionth of a step is rounding.
    const double left = end - time_;
    const bool last = left <= dt_ * (1 + 1e-6);
    step(last ? left : dt_);
    if (last) time_ = end;
  }
  if (changed_) prepare();  // a sphere broke in the last step
}

void RrlinearWorld::prepare() {
  changed_ = false;
  const std::vector<int> order = sort_spheres(spheres_, fixed_);
  {
    std::vector<std::uint8_t> fixed(fixed_.size());
    for (std::size_t k = 0; k < order.size(); ++k) fixed[k] = fixed_[order[k]];
    fixed_.swap(fixed);
  }
  const int n = spheres_.movable;
  // Sleepers do not bound the step, but a block or a tool must not pass over them in one.
  longest_step_ = kLargestStep;
  smallest_radius_ = 0;
  for (int i = 0; i < n; ++i) {
    const double radius = spheres_.place[i].w;
    if (spheres_.lost[i] || (smallest_radius_ > 0 && radius >= smallest_radius_)) continue;
    smallest_radius_ = radius;
    longest_step_ =
        std::min(kLargestStep, settings_.time_step_safety *
                                   std::sqrt(free_step2(radius, spheres_.velocity[i].w, spheres_.spin[i].w)));
  }
  sum_.assign(n, {});
  if (!growing_.empty()) {
    std::vector<int> place_of(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) place_of[order[k]] = static_cast<int>(k);
    for (GrowingSphere& g : growing_) g.sphere = place_of[g.sphere];
  }
  if (settings_.breakage.on()) {
    bears_.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
      bears_[i] = spheres_.velocity[i].w * settings_.breakage.strength(2 * spheres_.place[i].w);
    for (const GrowingSphere& g : growing_) bears_[g.sphere] = HUGE_VAL;
  }
  friction_.clear();
  if (!settings_.contact_effects.none()) {
    for (int i = 0; i < spheres_.size(); ++i) {
      const bool clump = !spheres_.partner.empty() && spheres_.partner[i] >= 0;
      const double of_grain = clump ? settings_.clumps.size() : 1.0;
      friction_.push_back(
          friction_factors(settings_.contact_effects, 2 * spheres_.place[i].w / of_grain, i >= n));
    }
  }

  pairs_.rebuild(spheres_, order, horizon());
  if (!before_fragments_) account_for_new(order, sorted_spheres_);
  sorted_spheres_ = spheres_.size();
  // A sphere that touched a mesh which was taken away has lost its hold.
  std::vector<std::uint8_t> stay_awake = facets_.renumber(order, spheres_, meshes_);
  facets_.set_tool_skin(kToolSkin * smallest_radius_);
  facets_.list_all(spheres_, pairs_, meshes_);
  find_watched();
  for (int i = 0; i < n; ++i) stay_awake[i] |= watched_[i];
  spheres_.join(stay_awake);
  sleep_.renumber(order, spheres_, pairs_, stay_awake, time_, settings_.gravity.norm());
  blocks_due_ = true;
  dt_ = stable_step();
  steps_to_check_ = 1;  // contacts have their forces then
  checks_to_energy_ = 1;
  energy_watch_.restart();
  if (before_fragments_) account_.fragments += energy_by_places() - *before_fragments_;
  before_fragments_.reset();
}

// Pairs of which one piece, with an index from `known` on before it was sorted in, was put upon the other.
void RrlinearWorld::account_for_new(const std::vector<int>& order, int known) {
  if (known == spheres_.size()) return;
  for (int i = 0; i < pairs_.rows(); ++i)
    for (const Neighbour& n : pairs_.owned(i))
      if (order[i] >= known || order[n.sphere] >= known) account_.pressed += held_by(i, n);
}

void RrlinearWorld::find_watched() {
  watched_.assign(spheres_.size(), 0);
  if (!sleep_.on()) return;
  for (const int i : facets_.near_tools(meshes_, time_)) watched_[i] = 1;
  for (const GrowingSphere& g : growing_) watched_[g.sphere] = 1;
  spheres_.join(watched_);
}

void RrlinearWorld::repair() {
  repair_due_ = false;
  ++statistics_.list_repairs;
  near_rim_.clear();
  for (const BlockWork& work : blocks_)
    near_rim_.insert(near_rim_.end(), work.near_rim.begin(), work.near_rim.end());
  const std::vector<int>& listed = pairs_.repair(spheres_, near_rim_, horizon());
  bool tools_moved = false;
  for (const auto& mesh : meshes_)
    if (mesh && mesh->moved_since_mark() > facets_.tool_skin()) tools_moved = true;
  if (!listed.empty() || tools_moved) facets_.list(listed, tools_moved, spheres_, pairs_, meshes_);
  if (!sleep_.on()) return;
  if (tools_moved) {
    find_watched();
    std::vector<int> watched;
    for (int i = 0; i < spheres_.movable; ++i)
      if (watched_[i]) watched.push_back(i);
    wake(watched);
  }
}

void RrlinearWorld::wake(std::vector<int>& disturbed) {
  if (disturbed.empty() || !sleep_.wake(disturbed, spheres_, pairs_)) return;
  for (const int i : disturbed) {
    sum_[i] = {};  // what was added while it slept
    double elastic = 0;
    for (const Neighbour& n : pairs_.neighbours(i)) elastic += elastic_energy_of(i, n);
    for (const MeshContact& c : mesh_contacts(i)) elastic += elastic_energy_of(c, i);
    energy_watch_.add_awake(potential_energy(i), elastic);
    if (settings_.fixed_time_step == 0)
      dt_ = std::min(dt_, settings_.time_step_safety * std::sqrt(own_step2(i)));
  }
  blocks_due_ = true;
}

void RrlinearWorld::split_awake() {
  blocks_due_ = false;
  split_into_blocks(sleep_.awake(), blocks_);
  block_at_.assign(spheres_.movable / kBlock + 1, -1);
  for (std::size_t k = 0; k < blocks_.size(); ++k) block_at_[blocks_[k].block] = static_cast<int>(k);
}

void RrlinearWorld::mesh_forces(BlockWork& work, double dt) {
  ContactLaw law = law_;
  FacetList::Contacts contacts;
  work.near_meshes.clear();
  work.supplied = work.tools = work.pressed = 0;
  for (const int i : work.awake)
    if (facets_.any(i)) work.near_meshes.push_back(i);
  constexpr std::size_t kAhead = 4;  // spheres whose contacts are on their way from memory
  for (std::size_t k = 0; k < work.near_meshes.size(); ++k) {
    if (k + kAhead < work.near_meshes.size()) facets_.fetch(work.near_meshes[k + kAhead]);
    const int i = work.near_meshes[k];
    const Quad place = spheres_.place[i];
    facets_.load(i, contacts);
    const int had = facets_.count(i);
    const MeshContactChanges changes =
        update_mesh_contacts(meshes_, facets_.facets(i), place.vec(), place.w, contacts);
    if (changes.born_inside > 0)
      __atomic_fetch_add(&statistics_.squeezed_into_walls, changes.born_inside, __ATOMIC_RELAXED);
    if (changes.without_slot > 0)
      __atomic_fetch_add(&statistics_.crowded_contacts, changes.without_slot, __ATOMIC_RELAXED);
    const Vec3 v = spheres_.velocity[i].vec(), w = spheres_.spin[i].vec();
    const FrictionFactors own = friction_.empty() ? FrictionFactors() : friction_[i];
    const ContactStiffness stiffness = ball_facet(law, place.w);
    ContactMotion motion;
    double arm = 0;
    Vec3 point;
    const auto opened = [&] { return motion.velocity.dot(motion.normal) * last_dt_; };
    const auto step_of = [&](MeshContact& c, bool went_on) {
      const MeshBody& body = *meshes_[c.body];
      law.mu = body.surface().mu * own.mu;
      law.mu_r = body.surface().mu_r * own.mu_r;
      law.pull = law_.pull + ContactLaw::pull_of(body.surface().surface_energy);
      arm = std::max(place.w - 0.5 * c.overlap, 0.1 * place.w);
      motion.normal = -c.normal;  // from the sphere to the surface
      point = place.vec() + arm * motion.normal;
      motion.overlap = c.overlap;
      motion.velocity = body.state().velocity_at(point) - v - arm * w.cross(motion.normal);
      motion.spin = body.state().spin - w;
      motion.twist = 0.5 * (w + body.state().spin).dot(motion.normal);
      motion.reduced_mass = spheres_.grain_mass(i);
      motion.dt = last_dt_;
      motion.pulls = 1;  // of one that goes on or begins while pressed
      if (law.pull > 0 && !went_on && c.overlap + opened() <= 0)
        motion.pulls = share_closed(c.overlap, motion.velocity.dot(motion.normal), last_dt_);
      const ContactForce f = contact_step(law, stiffness, motion, c.history);
      work.losses.add({f.loss.sliding, f.loss.rolling, f.loss.twisting, f.loss.dashpots, 0});
      return f;
    };
    const auto add = [&](const MeshContact& c, const ContactForce& f) {
      sum_[i].force.add(f.force);
      sum_[i].torque.add(arm * motion.normal.cross(f.force) + f.rolling);
      if (const MeshBody& body = *meshes_[c.body]; body.motion().moves()) {
        const double power = f.force.dot(body.state().velocity_at(point)) + f.rolling.dot(body.state().spin);
        work.supplied += std::max(0.0, last_dt_ * power);
        work.tools += 0.5 * (last_dt_ + dt) * power;
      }
    };
    // Where motion alone does not explain an overlap, at a corner or the rim of a face, a contact begins,
    // shifts or ends while pressed, and brings or takes energy (EnergyAccount::pressed). One that is there at
    // one end of the step only has half of its force on the way to the overlap that it would have at the
    // other.
    const auto jump = [&](double overlap, double other) {
      return 0.5 * (stiffness.kn * overlap * other - law.pull * stiffness.rbar * (overlap + other));
    };
    std::array<double, kMeshContactSlots> overlap_before;  // of those that go on
    int went_on = 0;
    for (int slot = 0; slot < had; ++slot) {
      const MeshContact& before = facets_.contact(i, slot);
      if (changes.went_on >> slot & 1u) {
        overlap_before[static_cast<std::size_t>(went_on++)] = before.overlap;
        continue;
      }
      MeshContact ended = before;
      ended.overlap = 0;
      step_of(ended, true);
      const double still = before.overlap - opened();
      if (still > 0)
        work.pressed -= jump(before.overlap, still);
      else if (law.pull > 0)
        add(ended,
            {.force = motion.normal * (law.pull * stiffness.rbar *
                                       share_closed(still, motion.velocity.dot(motion.normal), motion.dt)),
             .rolling = Vec3::Zero(),
             .loss = {}});
    }
    int count = 0;
    for (MeshContact& c : contacts) {
      if (c.body < 0) break;
      add(c, step_of(c, count < went_on));
      sum_[i].force.w += 1;
      work.overlap_ratio = std::max(work.overlap_ratio, c.overlap / place.w);
      if (count < went_on) {
        const double had_overlap = overlap_before[static_cast<std::size_t>(count)];
        work.pressed += (0.5 * stiffness.kn * (c.overlap + had_overlap) - law.pull * stiffness.rbar) *
                        (c.overlap - had_overlap + opened());
      } else if (const double already = c.overlap + opened(); already > 0) {
        work.pressed += jump(c.overlap, already);
      }
      ++count;
    }
    // A contact that begins deeper than the sphere moves in a step brings its energy with it.
    for (int begun = count - changes.begun; begun < count; ++begun) {
      const MeshContact& c = contacts[static_cast<std::size_t>(begun)];
      const double speed = (v - meshes_[c.body]->state().velocity_at(place.vec())).norm();
      if (c.overlap > 2.0 * speed * last_dt_) work.supplied += elastic_energy_of(c, i);
    }
    facets_.store(i, contacts);
  }
}

void RrlinearWorld::forces(double dt) {
  if (blocks_due_) split_awake();
  const StepView view{
      spheres_, pairs_,      sleep_,           law_, friction_.empty() ? nullptr : friction_.data(),
      last_dt_, sum_.data(), several_threads()};
  for_blocks([&](BlockWork& work) {
    contact_forces(view, work);
    mesh_forces(work, dt);
  });
  if (!several_threads()) return;
  for (BlockWork& work : blocks_) work.inbox.clear();
  for (auto from = blocks_.rbegin(); from != blocks_.rend(); ++from)
    for (const FarForces& far : from->written_down())
      if (const int at = block_at_[far.block]; at >= 0) blocks_[at].inbox.push_back(&far);
}

void RrlinearWorld::move_tools() {
  for (const auto& mesh : meshes_) {
    if (!mesh || !mesh->motion().moves()) continue;
    mesh->move_to(time_);
    if (mesh->moved_since_mark() > facets_.tool_skin()) repair_due_ = true;
    const double speed = mesh->fastest_point();
    if (settings_.fixed_time_step == 0 && smallest_radius_ > 0 &&
        speed * dt_ > kToolTravel * smallest_radius_)
      dt_ = kToolTravel * smallest_radius_ / speed;
  }
}

void RrlinearWorld::step(double dt) {
  forces(dt);
  const double alpha = settings_.material.local_damping,
               in_flight =
                   settings_.material.damping_reach == DampingReach::always ? settings_.flight_damping : 0.0;
  const Vec3 gravity =
      settings_.vibration.on() ? settings_.vibration.factor(time_) * settings_.gravity : settings_.gravity;
  const LeapfrogView view{spheres_, pairs_, sum_.data(), gravity, alpha, in_flight * alpha, dt};
  if (settings_.breakage.on()) for_blocks([&](BlockWork& work) { find_broken(work); });
  for_blocks([&](BlockWork& work) {
    leapfrog(view, work);
    if (settings_.vibration.on()) supply_of_vibration(work, dt);
  });
  if (settings_.clumps.on()) for_blocks([&](BlockWork& work) { move_clumps(view, settings_.clumps, work); });
  disturbed_.clear();
  Vec3 momentum = Vec3::Zero();
  for (BlockWork& work : blocks_) {
    account_.losses.add(work.losses);
    account_.tools += work.tools;
    account_.pressed += work.pressed;
    momentum += work.momentum;
    repair_due_ = repair_due_ || work.left_ball;
    energy_watch_.supply(work.supplied + std::max(work.pressed, 0.0));
    statistics_.largest_overlap_ratio = std::max(statistics_.largest_overlap_ratio, work.overlap_ratio);
    disturbed_.insert(disturbed_.end(), work.disturbed.begin(), work.disturbed.end());
  }
  account_.shaking += dt * (gravity - settings_.gravity).dot(momentum);
  statistics_.particle_steps += static_cast<double>(sleep_.awake().size());
  wake(disturbed_);
  statistics_.asleep = sleep_.asleep();
  time_ += dt;
  last_dt_ = dt;
  move_tools();
  if (repair_due_) repair();
  if (settings_.breakage.on()) break_spheres();
  ++statistics_.steps;
  statistics_.time_step_max = std::max(statistics_.time_step_max, dt);
  if (statistics_.time_step_min == 0 || dt_ < statistics_.time_step_min) statistics_.time_step_min = dt_;
}

// What a swing of gravity does to the spheres of a block beyond its mean (J): it may give them energy.
void RrlinearWorld::supply_of_vibration(BlockWork& work, double dt) const {
  const Vec3 more = (settings_.vibration.factor(time_) - 1) * settings_.gravity;
  for (const int i : work.awake) {
    const Quad& v = spheres_.velocity[i];
    work.supplied += std::max(0.0, v.w * more.dot(v.vec()) * dt);
  }
}

// Spheres in which a contact stores more energy than they can bear. Two spheres of one contact are springs in
// series, equally stiff, and bear one half each.
void RrlinearWorld::find_broken(BlockWork& work) const {
  work.broken.clear();
  for (const int i : work.awake) {
    double most = 0;
    for (const Neighbour& n : pairs_.neighbours(i)) {
      if (!n.touching()) continue;
      const Quad &a = spheres_.place[i], &b = spheres_.place[n.sphere];
      const double overlap = a.w + b.w - (b.vec() - a.vec()).norm();
      if (overlap > 0) most = std::max(most, 0.25 * ball_ball(law_, a.w, b.w).kn * overlap * overlap);
    }
    for (int k = 0; k < facets_.count(i); ++k) {
      const double overlap = facets_.contact(i, k).overlap;
      most = std::max(most, 0.5 * ball_facet(law_, spheres_.place[i].w).kn * overlap * overlap);
    }
    if (most > bears_[i]) work.broken.push_back(i);
  }
}

// Fragments in the place of the spheres that were found broken. What lay on these is woken; the step goes on
// from new lists.
void RrlinearWorld::break_spheres() {
  std::vector<int> broken, left_alone;
  for (BlockWork& work : blocks_) {
    broken.insert(broken.end(), work.broken.begin(), work.broken.end());
    work.broken.clear();
  }
  if (broken.empty()) return;
  before_fragments_ = energy_by_places();
  for (const int i : broken)
    for (const Neighbour& n : pairs_.neighbours(i)) {
      if (!n.touching()) continue;
      pairs_.memory(n) = {};  // the contact of another piece begins anew
      if (n.sphere < spheres_.movable) left_alone.push_back(n.sphere);
    }
  wake(left_alone);
  if (growing_.empty()) last_growth_ = time_;
  for (const int i : broken) {
    if (spheres_.lost[i]) continue;
    const double radius = Breakage::kSize * spheres_.place[i].w;
    for (const int fragment : replace_by_fragments(i)) growing_.push_back({fragment, radius});
  }
  changed_ = true;
}

// At a pace of the fragments' own, whatever the time step.
void RrlinearWorld::grow_fragments() {
  const double passed = time_ - last_growth_;
  last_growth_ = time_;
  std::erase_if(growing_, [&](const GrowingSphere& g) {
    const double step = std::sqrt(spheres_.velocity[g.sphere].w / ball_ball(law_, g.radius, g.radius).kn),
                 growth = std::pow(Breakage::kGrowth, passed / (Breakage::kGrowthSteps * step));
    const double grown = std::min(growth * spheres_.place[g.sphere].w, g.radius);
    if (!spheres_.lost[g.sphere]) set_radius(g.sphere, grown);
    return spheres_.lost[g.sphere] || grown == g.radius;
  });
}

// Square of the stable step of a sphere in flight (s2): it may meet one other at least, as stiff as a partner
// of any size can be, and as heavy as a dashpot can see it.
double RrlinearWorld::free_step2(double radius, double mass, double inertia) const {
  const ContactStiffness any = ball_ball(law_, radius, radius);
  const double across = radius * radius, turn = any.ks * across + any.kr;
  const double shift2 = mass / any.kn, turn2 = inertia / turn;
  if (!law_.has_dashpots()) return std::min(shift2, turn2);
  return std::min(with_dashpot(shift2, law_.beta_n),
                  with_dashpot(turn2, law_.beta_s * across * std::sqrt(mass * any.ks / (inertia * turn))));
}

// Square of the stable step of one sphere (s2): m / k and I / k_rot on its stiffest axis, over the contacts
// that it has and those that it may have soon, with their dashpots. Neighbours that move against it double
// stiffness k and viscosity c: its share of critical damping is c / sqrt(2 m k).
double RrlinearWorld::own_step2(int i) const {
  const Quad& a = spheres_.place[i];
  const bool damped = law_.has_dashpots();
  Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();  // N/m, N m/rad
  Vec3 drag = Vec3::Zero(), brake = Vec3::Zero();  // N s/m, N m s/rad
  const auto add = [&](const ContactStiffness& k, const Vec3& normal, double overlap, double reduced_mass) {
    const Vec3 along = normal.cwiseAbs2(), across = Vec3::Ones() - along;
    // The contact halves the overlap: of a small sphere pressed deep into a block it lies beyond the far
    // side.
    const double arm = std::max(a.w, 0.5 * overlap - a.w);
    shift += k.kn * along + k.ks * across;
    turn += (k.ks * arm * arm + k.kr) * across;
    if (law_.mu_t > 0) turn += k.kr * along;
    if (!damped) return;
    const double viscosity = shear_dashpot(law_, k, reduced_mass);
    drag += normal_dashpot(law_, k, reduced_mass) * along + viscosity * across;
    brake += viscosity * arm * arm * across;
  };
  for (const Neighbour& n : pairs_.neighbours(i)) {
    const Quad& b = spheres_.place[n.sphere];
    const Vec3 d = b.vec() - a.vec();
    const double reach = a.w + b.w + kNearGap * std::min(a.w, b.w), d2 = d.squaredNorm();
    if (d2 >= reach * reach || !(d2 > 0)) continue;
    const double distance = std::sqrt(d2);
    add(ball_ball(law_, a.w, b.w), d / distance, a.w + b.w - distance,
        damped ? spheres_.reduced_mass(i, n.sphere) : 0);
  }
  if (facets_.any(i)) {
    const ContactStiffness wall = ball_facet(law_, a.w);
    const double mass = spheres_.grain_mass(i);
    // Of these the arm is never longer than the radius (mesh_forces).
    for (int k = 0; k < facets_.count(i); ++k) add(wall, facets_.contact(i, k).normal, 0, mass);
    if (facets_.count(i) == 0) add(wall, Vec3(0, 0, 1), 0, mass);
  }
  const double mass = spheres_.velocity[i].w, inertia = spheres_.spin[i].w;
  const double free = free_step2(a.w, mass, inertia);
  if (!damped)
    return std::min(
        {free, mass / std::max(shift.maxCoeff(), 1e-300), inertia / std::max(turn.maxCoeff(), 1e-300)});
  const auto stable = [](double own, double stiffness, double viscosity) {
    const double k = std::max(stiffness, 1e-300);
    return with_dashpot(own / k, viscosity / std::sqrt(2 * own * k));
  };
  double step2 = free;
  for (int axis = 0; axis < 3; ++axis)
    step2 =
        std::min({step2, stable(mass, shift[axis], drag[axis]), stable(inertia, turn[axis], brake[axis])});
  return step2;
}

double RrlinearWorld::stable_step() {
  if (settings_.fixed_time_step > 0) return settings_.fixed_time_step;
  if (blocks_due_) split_awake();
  for_blocks([&](BlockWork& work) {
    work.step2 = kLargestStep * kLargestStep;
    work.travel = kLargestStep;
    for (const int i : work.awake) {
      work.step2 = std::min(work.step2, own_step2(i));
      const double speed = spheres_.velocity[i].vec().norm(), most = kMostTravel * spheres_.place[i].w;
      if (speed * work.travel > most) work.travel = most / speed;
    }
  });
  double step2 = kLargestStep * kLargestStep, travel = kLargestStep;
  for (const BlockWork& work : blocks_) {
    step2 = std::min(step2, work.step2);
    travel = std::min(travel, work.travel);
  }
  const double swing = settings_.vibration.on() ? settings_.vibration.longest_step() : kLargestStep;
  return std::min({settings_.time_step_safety * std::sqrt(step2), travel, longest_step_, swing});
}

// Of gravity, and of the pull of its contacts with meshes and sleepers, J.
double RrlinearWorld::potential_energy(int i) const {
  double energy = gravity_energy(i);
  if (law_.pull > 0)
    for (const Neighbour& n : pairs_.neighbours(i))
      if (n.touching() && (n.sphere >= spheres_.movable || spheres_.asleep[n.sphere]))
        energy -= pull_work(i, n);
  for (int k = 0; k < facets_.count(i); ++k)
    if (const MeshContact& c = facets_.contact(i, k); meshes_[c.body]) energy -= pull_work(c, i);
  return energy;
}

// What the pull of a contact has done since it closed, J.
double RrlinearWorld::pull_work(int i, const Neighbour& n) const {
  const Quad &a = spheres_.place[i], &b = spheres_.place[n.sphere];
  const double overlap = a.w + b.w - (b.vec() - a.vec()).norm();
  return law_.pull * ball_ball(law_, a.w, b.w).rbar * std::max(overlap, 0.0);
}
double RrlinearWorld::pull_work(const MeshContact& c, int i) const {
  const double pull = law_.pull + ContactLaw::pull_of(meshes_[c.body]->surface().surface_energy);
  return pull * spheres_.place[i].w * c.overlap;
}

// Elastic energy of the contact of sphere i with a neighbour, J.
double RrlinearWorld::elastic_energy_of(int i, const Neighbour& n) const {
  const Quad &a = spheres_.place[i], &b = spheres_.place[n.sphere];
  const double overlap = a.w + b.w - (b.vec() - a.vec()).norm();
  if (overlap <= 0) return 0;
  return elastic_energy(ball_ball(law_, a.w, b.w), overlap, pairs_.memory(n).history());
}

// Elastic energy of a contact of sphere i with a mesh, J.
double RrlinearWorld::elastic_energy_of(const MeshContact& c, int i) const {
  return elastic_energy(ball_facet(law_, spheres_.place[i].w), c.overlap, c.history);
}

AwakeEnergy RrlinearWorld::awake_energy(const BlockWork& work) const {
  AwakeEnergy e;
  for (const int i : work.awake) {
    const Quad &x = spheres_.place[i], &v = spheres_.velocity[i];
    e.kinetic += spheres_.kinetic_energy(i);
    e.potential += potential_energy(i);
    e.scale += v.w * settings_.gravity.norm() * x.w;
    for (int k = 0; k < facets_.count(i); ++k) e.elastic += elastic_energy_of(facets_.contact(i, k), i);
    for (const Neighbour& n : pairs_.neighbours(i))
      if (n.sphere > i || spheres_.asleep[n.sphere]) {
        e.elastic += elastic_energy_of(i, n);
        if (law_.pull > 0 && n.sphere < spheres_.movable && !spheres_.asleep[n.sphere])
          e.potential -= pull_work(i, n);
      }
  }
  return e;
}

void RrlinearWorld::check_energy() {
  checks_to_energy_ = kChecksToEnergy;
  if (blocks_due_) split_awake();
  for_blocks([&](BlockWork& work) { work.energy = awake_energy(work); });
  AwakeEnergy now;
  for (const BlockWork& work : blocks_) {
    now.kinetic += work.energy.kinetic;
    now.elastic += work.energy.elastic;
    now.potential += work.energy.potential;
    now.scale += work.energy.scale;
  }
  energy_watch_.check(now, account_.losses.total() - account_.losses.dashpots, time_);
}

Energy RrlinearWorld::energy() const {
  Energy e = RockWorld::energy();
  for (int i = 0; i < std::min(spheres_.movable, pairs_.rows()); ++i)  // no rows before the first step
    for (const Neighbour& n : pairs_.owned(i))
      if (n.touching()) e.elastic += elastic_energy_of(i, n), e.pull -= pull_work(i, n);
  for (int i = 0; i < facets_.rows(); ++i)
    for (const MeshContact& c : mesh_contacts(i))
      e.elastic += elastic_energy_of(c, i), e.pull -= pull_work(c, i);
  return e;
}

// The same with contacts that have closed since the last step, and will be known at the next.
double RrlinearWorld::energy_by_places() const {
  Energy e = energy();
  for (int i = 0; i < pairs_.rows(); ++i)
    for (const Neighbour& n : pairs_.owned(i))
      if (!n.touching()) e.elastic += held_by(i, n);
  return e.total();
}

std::optional<EnergyBalance> RrlinearWorld::energy_balance() const {
  return EnergyBalance{energy(), account_};
}

std::vector<MeshContact> RrlinearWorld::mesh_contacts(int index) const {
  std::vector<MeshContact> contacts;
  if (index < facets_.rows())
    for (int k = 0; k < facets_.count(index); ++k)
      if (const MeshContact& c = facets_.contact(index, k); meshes_[c.body]) contacts.push_back(c);
  return contacts;
}

std::size_t RrlinearWorld::bytes() const {
  std::size_t bytes = spheres_.bytes() + pairs_.bytes() + facets_.bytes() + sleep_.bytes() +
                      sum_.capacity() * sizeof(ForceSum);
  for (const BlockWork& work : blocks_)
    for (const FarForces& far : work.far) bytes += far.entries.capacity() * sizeof(FarForces::Entry);
  return bytes;
}

void RrlinearWorld::update_bullet() {
  make_bodies();
  for (const auto& mesh : meshes_)
    if (mesh && mesh->motion().moves()) {
      mesh->write_back();
      updateSingleAabb(&mesh->body());
    }
  for (int i = 0; i < spheres_.movable; ++i) {
    if (spheres_.lost[i]) continue;
    btRigidBody& body = *bodies_[static_cast<std::size_t>(spheres_.id[i])];
    const btVector3 origin = to_bullet(spheres_.place[i].vec());
    const btVector3 velocity = to_bullet(spheres_.velocity[i].vec());
    if (origin == body.getWorldTransform().getOrigin() && velocity == body.getLinearVelocity()) continue;
    body.getWorldTransform().setOrigin(origin);
    body.setLinearVelocity(velocity);
    body.setAngularVelocity(to_bullet(spheres_.spin[i].vec()));
    updateSingleAabb(&body);
  }
}

}  // namespace scree
