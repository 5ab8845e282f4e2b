// scree_micro: times of the parts of a step, each alone (Google Benchmark), as CSV.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <random>

#include "bench/frozen_step.h"
#include "bench/scenes.h"

namespace scree::bench {
namespace {

// One of what `label` names first is one item.
void each(benchmark::State& state, double items_of_an_iteration, const std::string& label) {
  state.counters["items"] = items_of_an_iteration;
  state.SetLabel(label);
}

// CSV on stdout: the fastest of the repetitions, in time of the processor, not of the clock. Others who use
// the machine slow some repetitions down, not all.
class NanosecondsEach : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    fmt::print("benchmark,ns,for_each,of\n");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    if (runs.empty() || runs.front().run_type != Run::RT_Iteration) return;  // means and the like
    double best = 1e300;
    for (const Run& run : runs)
      best = std::min(best, 1e9 * run.cpu_accumulated_time / static_cast<double>(run.iterations) /
                                run.counters.at("items").value);
    const Run& any = runs.front();
    const std::string &args = any.run_name.args, &label = any.report_label;
    const std::size_t cut = label.find("; ");
    fmt::print("{}{}{},{:.2f},{},\"{}\"\n", any.run_name.function_name, args.empty() ? "" : "/", args, best,
               label.substr(0, cut), label.substr(cut + 2));
    std::fflush(stdout);
  }
};

// --- The contact law.

constexpr int kContacts = 64;  // independent ones, in the first cache

template <class Stiffness, class Motion, class History, class Force>
struct alignas(32) AnyContact {  // lanes by themselves are aligned like that in vectorised functions only
  Stiffness stiffness;
  Motion motion;
  History history;
  Force force;
};
using Contact = AnyContact<ContactStiffness, ContactMotion, ContactHistory, ContactForce>;
using LaneContact =
    AnyContact<BasicContactStiffness<Lanes>, LaneContactMotion, LaneContactHistory, BasicContactForce<Lanes>>;

void law_one_by_one(const ContactLaw& law, std::vector<Contact>& contacts) {
  for (Contact& c : contacts) c.force = contact_step(law, c.stiffness, c.motion, c.history);
}
SCREE_VECTORISED
void law_by_fours(const ContactLaw& law, std::vector<LaneContact>& contacts) {
  PlainFriction friction{law.mu, law.mu_r};
  for (LaneContact& c : contacts) c.force = contact_step(law, friction, c.stiffness, c.motion, c.history);
}

// One of four slides, the others stick: their memory stays as it is.
std::vector<Contact> some_contacts(const ContactLaw& law) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const auto vector = [&] { return Vec3(share(random), share(random), share(random)); };
  std::vector<Contact> contacts(kContacts);
  for (Contact& c : contacts) {
    c.stiffness = ball_ball(law, 0.3 + 0.2 * share(random), 0.3 + 0.2 * share(random));
    c.motion = {vector().normalized(), 1e-3, Vec3::Zero(), Vec3::Zero(), 0.0, 0.0, 1e-3};
    if (share(random) < -0.5) c.motion.velocity = vector(), c.motion.spin = vector();
    const double limit = 0.3 * law.mu * c.stiffness.kn * c.motion.overlap;
    c.history = {limit * c.motion.normal.cross(vector()),
                 limit * c.stiffness.rbar * c.motion.normal.cross(vector())};
  }
  return contacts;
}

LaneContact four_of(const Contact* c) {
  LaneContact four;
  for (int k = 0; k < kLanes; ++k) {
    four.stiffness.kn[k] = c[k].stiffness.kn;
    four.stiffness.ks[k] = c[k].stiffness.ks;
    four.stiffness.kr[k] = c[k].stiffness.kr;
    four.stiffness.rbar[k] = c[k].stiffness.rbar;
    const Vec3 &n = c[k].motion.normal, &v = c[k].motion.velocity, &w = c[k].motion.spin;
    four.motion.normal.x_[k] = n.x(), four.motion.normal.y_[k] = n.y(), four.motion.normal.z_[k] = n.z();
    const auto set = [&](LaneVector<TwinFloats>& to, const Vec3& first, const Vec3& second) {
      to.x_[k] = static_cast<float>(first.x()), to.x_[k + kLanes] = static_cast<float>(second.x());
      to.y_[k] = static_cast<float>(first.y()), to.y_[k + kLanes] = static_cast<float>(second.y());
      to.z_[k] = static_cast<float>(first.z()), to.z_[k + kLanes] = static_cast<float>(second.z());
    };
    set(four.motion.velocity_and_spin, v, w);
    set(four.history.springs, c[k].history.shear, c[k].history.rolling);
    four.motion.overlap[k] = c[k].motion.overlap;
  }
  four.history.further = TwinFloats{};
  four.motion.twist = LaneFloats{};
  four.motion.reduced_mass = Lanes{};
  four.motion.dt = c[0].motion.dt;
  return four;
}

void law_of_one(benchmark::State& state) {
  const ContactLaw law{Material{}};
  std::vector<Contact> contacts = some_contacts(law);
  for (auto _ : state) {
    law_one_by_one(law, contacts);
    benchmark::DoNotOptimize(contacts.data());
    benchmark::ClobberMemory();
  }
  each(state, kContacts, "contact; one double at a time, base instruction set, as with meshes");
}
BENCHMARK(law_of_one);

void law_of_four(benchmark::State& state) {
  const ContactLaw law{Material{}};
  const std::vector<Contact> single = some_contacts(law);
  std::vector<LaneContact> contacts;
  for (int k = 0; k < kContacts; k += kLanes) contacts.push_back(four_of(&single[k]));
  for (auto _ : state) {
    law_by_fours(law, contacts);
    benchmark::DoNotOptimize(contacts.data());
    benchmark::ClobberMemory();
  }
  each(state, kContacts, "contact; four lanes, memory in single precision, best instruction set");
}
BENCHMARK(law_of_four);

// --- The two loops of a step, on a heap at rest.

// Some 10,000 spheres of QB0 (0.1 to 2.66 m) at rest in their box, nothing asleep.
RrlinearWorld& settled_heap() {
  static const std::unique_ptr<RockWorld> world = [] {
    auto heap = make_scene("heap", heap_packing(10000), {});
    heap->advance_to(4.0);
    return heap;
  }();
  return dynamic_cast<RrlinearWorld&>(*world);
}

enum Per { per_contact, per_pair };

// All blocks of the heap, or one of the middle alone, whose data stay in the second cache.
void forces_of_spheres(benchmark::State& state, bool all, Per per) {
  FrozenStep step(settled_heap());
  const int first = all ? 0 : step.blocks() / 2, last = all ? step.blocks() : first + 1;
  for (auto _ : state)
    for (int b = last; b-- > first;) step.forces(b);
  const double n = step.spheres(first, last), closed = step.pairs(first, last, true),
               listed = step.pairs(first, last, false);
  each(state, per == per_contact ? closed : listed,
       fmt::format("{}; {:.0f} spheres, {:.2f} closed contacts and {:.2f} listed pairs a sphere",
                   per == per_contact ? "closed contact" : "listed pair", n, closed / n, listed / n));
}
BENCHMARK_CAPTURE(forces_of_spheres, all_blocks_per_contact, true, per_contact);
BENCHMARK_CAPTURE(forces_of_spheres, all_blocks_per_pair, true, per_pair);
BENCHMARK_CAPTURE(forces_of_spheres, one_block_per_contact, false, per_contact);
BENCHMARK_CAPTURE(forces_of_spheres, one_block_per_pair, false, per_pair);

void leapfrog_of_spheres(benchmark::State& state, bool all) {
  FrozenStep step(settled_heap());
  const int first = all ? 0 : step.blocks() / 2, last = all ? step.blocks() : first + 1;
  for (auto _ : state)
    for (int b = last; b-- > first;) step.move(b);
  each(state, step.spheres(first, last), fmt::format("sphere; {:.0f} spheres", step.spheres(first, last)));
}
BENCHMARK_CAPTURE(leapfrog_of_spheres, all_blocks, true);
BENCHMARK_CAPTURE(leapfrog_of_spheres, one_block, false);

// --- Neighbours.

constexpr double kHorizon = 0.025;  // s, some 20 steps: how long a ball should last

// `tiles` settled heaps side by side, sorted along the Morton curve.
Spheres settled_spheres(int tiles) {
  const Spheres& heap = settled_heap().spheres();
  double low = 1e300, high = -1e300;
  for (const Quad& p : heap.place) low = std::min(low, p.x - p.w), high = std::max(high, p.x + p.w);
  Spheres all = heap;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (int t = 1; t < tiles; ++t) {
    append(all.place, heap.place);
    for (std::size_t k = all.place.size() - heap.place.size(); k < all.place.size(); ++k)
      all.place[k].x += t * (high - low);
    append(all.velocity, heap.velocity);
    append(all.spin, heap.spin);
    for (const std::int64_t id : heap.id) all.id.push_back(id + t * heap.size());
    append(all.dump, heap.dump);
    append(all.lost, heap.lost);
    append(all.asleep, heap.asleep);
  }
  sort_spheres(all, std::vector<std::uint8_t>(all.place.size(), 0));
  return all;
}

void pair_list_rebuild(benchmark::State& state) {
  const Spheres spheres = settled_spheres(static_cast<int>(state.range(0)));
  const std::vector<int> order = as_they_are(spheres.size());
  PairList pairs;
  for (auto _ : state) pairs.rebuild(spheres, order, kHorizon);
  each(state, spheres.size(), fmt::format("sphere; {} spheres", spheres.size()));
}
BENCHMARK(pair_list_rebuild)->ArgName("heaps")->Arg(1)->Arg(10);

// Spheres drawn at random go to and fro by most of their skin, so that they are listed anew and no others.
void pair_list_repair(benchmark::State& state) {
  Spheres spheres = settled_spheres(static_cast<int>(state.range(0)));
  const std::vector<int> all = as_they_are(spheres.size());
  PairList pairs;
  pairs.rebuild(spheres, all, kHorizon);
  std::mt19937 random(1);
  std::bernoulli_distribution chosen(0.01 * static_cast<double>(state.range(1)));
  struct Mover {
    int sphere;
    double way;
  };
  std::vector<Mover> movers;
  for (const int i : all)
    if (chosen(random)) movers.push_back({i, 1.1 * pairs.skin(i, spheres.place[i])});
  std::size_t listed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    for (Mover& m : movers) {
      spheres.place[m.sphere].x += m.way;
      m.way = -m.way;
    }
    state.ResumeTiming();
    listed = pairs.repair(spheres, all, kHorizon).size();
  }
  each(state, static_cast<double>(listed),
       fmt::format("sphere listed anew; {} of {} spheres", listed, spheres.size()));
}
BENCHMARK(pair_list_repair)->ArgNames({"heaps", "percent"})->ArgsProduct({{1, 10}, {1, 10}});

void grid_query(benchmark::State& state) {
  const Spheres spheres = settled_spheres(static_cast<int>(state.range(0)));
  double smallest = 1e300, largest = 0;
  for (const Quad& p : spheres.place) smallest = std::min(smallest, p.w), largest = std::max(largest, p.w);
  constexpr double kReach = 1.12;  // of the radius: the skin of a sphere at rest
  NeighbourGrid grid;
  grid.reset(spheres.size(), kReach * smallest, 2.0 * largest);
  for (int i = 0; i < spheres.size(); ++i) grid.place(i, spheres.place[i].vec(), kReach * spheres.place[i].w);
  std::int64_t found = 0, queries = 0;
  for (auto _ : state) {
    for (int i = 0; i < spheres.size(); ++i) grid.query(i, [&](int) { ++found; });
    queries += spheres.size();
    benchmark::DoNotOptimize(found);
  }
  each(state, spheres.size(),
       fmt::format("query; {} spheres, {:.1f} found by each", spheres.size(),
                   static_cast<double>(found) / static_cast<double>(queries)));
}
BENCHMARK(grid_query)->ArgName("heaps")->Arg(1)->Arg(10);

// --- Meshes.

constexpr double kRadius = 0.5, kSkin = 0.06;  // m

// A square of 10 m at z = 0, cut into nx x ny rectangles of two triangles.
TriangleMesh plane(int nx, int ny) {
  TriangleMesh mesh;
  for (int y = 0; y <= ny; ++y)
    for (int x = 0; x <= nx; ++x) mesh.vertices.emplace_back(10.0 * x / nx - 5.0, 10.0 * y / ny - 5.0, 0.0);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const int a = y * (nx + 1) + x, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

// Finds the contacts of one sphere `gap` (m) above a plane with the facets that FacetList would list.
void mesh_contacts(benchmark::State& state, int nx, int ny, double gap) {
  std::vector<std::unique_ptr<MeshBody>> bodies;
  bodies.push_back(std::make_unique<MeshBody>(plane(nx, ny), Surface{}, Motion()));
  const Vec3 centre(0.31, 0.12, kRadius + gap);
  std::vector<int> near;
  bodies[0]->facets_near(centre, kRadius + kSkin, near);
  std::vector<FacetRef> facets;
  for (const int f : near)
    if (bodies[0]->facets()[f].box_within(centre, kRadius + kSkin)) facets.push_back({0, f});
  std::array<MeshContact, kMeshContactSlots> slots;
  for (auto _ : state) {
    const MeshContactChanges changes = update_mesh_contacts(bodies, facets, centre, kRadius, slots);
    benchmark::DoNotOptimize(changes);
    benchmark::ClobberMemory();
  }
  int closed = 0;
  for (const MeshContact& c : slots) closed += c.body >= 0 ? 1 : 0;
  each(
      state, 1,
      fmt::format("sphere; {} triangles, {} listed, {} closed contacts", 2 * nx * ny, facets.size(), closed));
}
BENCHMARK_CAPTURE(mesh_contacts, two_triangles_touching, 1, 1, -0.001);
BENCHMARK_CAPTURE(mesh_contacts, two_triangles_near, 1, 1, 0.03);
BENCHMARK_CAPTURE(mesh_contacts, fine_mesh_touching, 20, 25, -0.001);
BENCHMARK_CAPTURE(mesh_contacts, fine_mesh_near, 20, 25, 0.03);

void facets_near(benchmark::State& state, int nx, int ny) {
  const MeshBody body(plane(nx, ny), Surface{}, Motion());
  std::vector<int> found;
  for (auto _ : state) {
    found.clear();
    body.facets_near(Vec3(0.31, 0.12, kRadius), kRadius + kSkin, found);
    benchmark::DoNotOptimize(found.data());
    benchmark::ClobberMemory();
  }
  each(state, 1, fmt::format("query; {} triangles, {} found", 2 * nx * ny, found.size()));
}
BENCHMARK_CAPTURE(facets_near, two_triangles, 1, 1);
BENCHMARK_CAPTURE(facets_near, fine_mesh, 20, 25);

// --- Whole steps.

void whole_steps(benchmark::State& state, RrlinearWorld& world, double span) {
  const WorldStatistics before = world.statistics();
  for (auto _ : state) world.advance_to(world.time() + span);
  const double done = world.statistics().particle_steps - before.particle_steps;
  const int n = world.spheres().movable;
  double closed = 0, listed = 0, mesh = 0;
  for (int i = 0; i < n; ++i) {
    for (const Neighbour& p : world.pairs().owned(i)) ++listed, closed += p.touching() ? 1 : 0;
    mesh += static_cast<double>(world.mesh_contacts(i).size());
  }
  each(state, done / static_cast<double>(state.iterations()),
       fmt::format(
           "sphere and step; {} spheres, {:.2f} closed contacts, {:.2f} listed pairs, {:.2f} contacts with "
           "meshes a sphere",
           n, closed / n, listed / n, mesh / n));
}

void whole_steps_heap(benchmark::State& state) {
  whole_steps(state, settled_heap(), 0.02);
}
BENCHMARK(whole_steps_heap)->Iterations(20);

// Settled in its bucket; the lift begins, and the rock in the bucket is still at rest.
void whole_steps_lab(benchmark::State& state, const std::string& file) {
  static const Packing packing = file.empty() ? lab_packing(5.0, 0.60) : read_packing(file);
  const auto world = make_scene("lab", packing, {});
  world->advance_to(0.02);  // contacts get their memory back
  whole_steps(state, dynamic_cast<RrlinearWorld&>(*world), 0.002);
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  // Defaults first, so that the command line replaces them.
  char repetitions[] = "--benchmark_repetitions=5", least[] = "--benchmark_min_time=0.1";
  std::vector<char*> arguments = {argv[0], repetitions, least};
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  argc = static_cast<int>(arguments.size());
  argv = arguments.data();
  benchmark::Initialize(&argc, argv);
  std::string lab;
  CLI::App app("Times the parts of a step, each alone; takes the options of Google Benchmark too.");
  app.add_option("--lab", lab,
                 "packing of the laboratory (scree_bench pack lab); none: 5 kg are settled first");
  CLI11_PARSE(app, argc, argv);
  benchmark::RegisterBenchmark("whole_steps_lab", scree::bench::whole_steps_lab, lab)->Iterations(20);
  scree::bench::NanosecondsEach reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
