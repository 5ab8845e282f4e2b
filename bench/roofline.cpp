// scree_roofline: how fast a step could be on this machine at most, and how fast it is.
//
// Measures bandwidth and arithmetic of the machine, counts what a contact and a sphere need of both, and
// holds the real time of a step against the time that each alone would take.
#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <fstream>

#include "bench/frozen_step.h"
#include "bench/scenes.h"

namespace scree::bench {
namespace {

// --- What the hot path needs, counted by hand in step_kernels.cpp and rrlinear.h for the law without
// dashpots (beta_n = beta_s = 0). Comparisons, choices, shuffles and conversions are not counted.

struct Operations {
  double adds, multiplications, divisions, roots;
  double single_divisions = 0, single_roots = 0;  // in single precision, on vectors of twice as many
  constexpr double flops() const { return adds + multiplications; }
  constexpr Operations operator+(const Operations& b) const {
    return {adds + b.adds,   multiplications + b.multiplications,   divisions + b.divisions,
            roots + b.roots, single_divisions + b.single_divisions, single_roots + b.single_roots};
  }
  constexpr Operations operator*(double n) const {
    return {n * adds, n * multiplications, n * divisions, n * roots, n * single_divisions, n * single_roots};
  }
};

// ball_ball(): per_length 1 add (shared with the overlap) and 1 division; rbar 2, kn 3, ks 1, kr 2
// multiplications.
constexpr Operations kStiffness = {1, 8, 1, 0};
// compute() before the law: apart 3 adds; distance 2 adds, 3 multiplications, 1 root, 1 division; normal 3
// multiplications; overlap 1 add; arms 2 adds, 1 multiplication; motions_of() 8 adds; rim 6 adds, 12
// multiplications; velocity 3 adds; twist 5 adds, 4 multiplications.
constexpr Operations kMotion = {30, 23, 1, 1};
// From here on shear and rolling share a register in single precision: an operation on both counts once.
// turned_with_contact(): flat 5 adds, 6 multiplications; twist 3 adds, 9 multiplications; two lengths 2 adds,
// 4 multiplications, 1 more for the comparison; excess 2 adds, 3 multiplications, 1 division; series 2 adds,
// 3 multiplications; the sum 12 adds, 3 multiplications.
constexpr Operations kTurn = {26, 29, 0, 0, 1, 0};
// Rest of contact_step(): fn 1 multiplication; slip and bend 5 adds, 6 multiplications; twist angle 1;
// increments 3 adds, 3 multiplications; stiffnesses 2, limits 3 multiplications; length 2 adds, 3
// multiplications, limit squared 1; share 1 division, 1 root; 3 to apply it; force 3 adds, 3 multiplications.
// Work of the slip: 6 adds, two of them to the sums, 6 multiplications, 1 division.
constexpr Operations kLaw = {19, 32, 0, 0, 2, 1};
// compute() after the law: lever 3 adds, 6 multiplications; two moments 6 adds, 6 multiplications; overlap
// ratio 1 division. add_force(): four sums of four numbers.
constexpr Operations kSums = {9 + 16, 12, 1, 0};
constexpr Operations of_contact() {
  return kStiffness + kMotion + kTurn + kLaw + kSums;
}
// sieve(), for each open pair: apart 3 adds, reach 1, square of the distance 2 adds and 3
// multiplications, reach squared 1, difference 1 add.
constexpr Operations kPair = {7, 4, 0, 0};
// leapfrog(), vectors of four numbers: weight 4 adds, 4 multiplications; two dampings 8 adds, 16
// multiplications; two steps of velocity 8 adds, 8 multiplications, 8 divisions; place 4 adds, 4
// multiplications; work of two dampings 16 adds, 8 multiplications; momentum 4 adds, 4 multiplications.
// way_out2(): 6 adds, 4 multiplications, 1 division.
constexpr Operations kSphere = {50, 48, 9, 0};

// Bytes that a step moves, read and written each counted once, as STREAM does, when nothing but the block in
// work stays in the cache: contact_forces() of all blocks, then leapfrog() of all blocks.
struct Traffic {
  const char* what;
  double read, written;
};
constexpr double kQuad = sizeof(Quad);
// Each sphere; neighbours in space are neighbours in memory, so a partner is in the cache already.
constexpr Traffic kOfSphere[] = {
    {"forces: place, velocity, spin", 3 * kQuad, 0},
    {"forces: sums of force and moment", 0, sizeof(ForceSum)},
    {"forces: numbers of awake spheres", sizeof(int), 0},
    {"forces: begin, count and capacity of the row, entries below", 3 * sizeof(int) + sizeof(int), 0},
    {"meshes: number of the slot", sizeof(int), 0},
    {"leapfrog: sums", sizeof(ForceSum), 0},
    {"leapfrog: place, velocity, spin", 3 * kQuad, 3 * kQuad},
    {"leapfrog: its ball", kQuad, 0},
    {"leapfrog: numbers of awake spheres", sizeof(int), 0},
};
// Each listed pair: its entry in the owner's row. The partner's entry lies in the same lines as entries that
// are read, in part, and is not counted.
constexpr Traffic kOfPair[] = {{"entry", sizeof(Neighbour), 0}};
// Each closed contact.
constexpr Traffic kOfContact[] = {{"memory", sizeof(ContactMemory), sizeof(ContactMemory)}};
// Each listed pair that is open: its memory is fetched ahead all the same.
constexpr Traffic kOfOpenPair[] = {{"memory fetched in vain", sizeof(ContactMemory), 0}};

template <std::size_t n>
constexpr double bytes(const Traffic (&table)[n]) {
  double sum = 0;
  for (const Traffic& t : table) sum += t.read + t.written;
  return sum;
}

// --- The machine.

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Shortest of many short runs of body(), in seconds: others who use the machine lengthen some, not all.
template <class Body>
double shortest(Body&& body) {
  double best = 1e300;
  const double begin = now();
  for (int k = 0; k < 5 || (now() - begin < 0.5 && k < 1000); ++k) {
    const double start = now();
    body();
    best = std::min(best, now() - start);
  }
  return best;
}

SCREE_VECTORISED
void copy(double* to, const double* from, std::size_t count, int passes) {
  for (int p = 0; p < passes; ++p) {
    for (std::size_t k = 0; k < count; ++k) to[k] = from[k];
    asm volatile("" ::: "memory");
  }
}
SCREE_VECTORISED
void triad(double* a, const double* b, const double* c, std::size_t count, int passes) {
  for (int p = 0; p < passes; ++p) {
    for (std::size_t k = 0; k < count; ++k) a[k] = b[k] + 3.0 * c[k];
    asm volatile("" ::: "memory");
  }
}

struct Bandwidth {
  double copy, triad;  // bytes/s
};

// Every thread has `set` bytes of its own.
Bandwidth bandwidth(std::size_t set, int threads) {
  const std::size_t two = set / 2 / sizeof(double), three = set / 3 / sizeof(double);
  const int passes = static_cast<int>(std::max<std::size_t>(1, (std::size_t{32} << 20) / set));
  std::vector<std::vector<double>> arrays(threads);
#pragma omp parallel num_threads(threads)
  arrays[omp_get_thread_num()].assign(3 * std::max(two, three), 1.0);
  const auto run = [&](auto&& kernel) {
    return shortest([&] {
#pragma omp parallel num_threads(threads)
      kernel(arrays[omp_get_thread_num()].data());
    });
  };
  const double copying = run([&](double* a) { copy(a, a + two, two, passes); });
  const double adding = run([&](double* a) { triad(a, a + three, a + 2 * three, three, passes); });
  const double t = threads, p = passes, word = sizeof(double);
  return {2 * word * t * p * static_cast<double>(two) / copying,
          3 * word * t * p * static_cast<double>(three) / adding};
}

constexpr int kChains = 6, kLinks = 100000;

// Independent chains: as many additions as multiplications.
SCREE_VECTORISED
void add_and_multiply(Lanes* a, Lanes* m, double more, double times) {
  Lanes a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], a4 = a[4], a5 = a[5];
  Lanes m0 = m[0], m1 = m[1], m2 = m[2], m3 = m[3], m4 = m[4], m5 = m[5];
  const Lanes d = Lanes{} + more, f = Lanes{} + times;
  for (int k = 0; k < kLinks; ++k) {
    a0 += d, m0 *= f, a1 += d, m1 *= f, a2 += d, m2 *= f;
    a3 += d, m3 *= f, a4 += d, m4 *= f, a5 += d, m5 *= f;
  }
  a[0] = a0, a[1] = a1, a[2] = a2, a[3] = a3, a[4] = a4, a[5] = a5;
  m[0] = m0, m[1] = m1, m[2] = m2, m[3] = m3, m[4] = m4, m[5] = m5;
}
template <class Vector>
SCREE_INLINE void divide_by_all(Vector* a, Vector d) {
  Vector a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], a4 = a[4], a5 = a[5];
  for (int k = 0; k < kLinks; ++k)
    a0 = d / a0, a1 = d / a1, a2 = d / a2, a3 = d / a3, a4 = d / a4, a5 = d / a5;
  a[0] = a0, a[1] = a1, a[2] = a2, a[3] = a3, a[4] = a4, a[5] = a5;
}
// `d`: without it they would all become 1, which may be a fast case.
template <class Vector>
SCREE_INLINE void take_all_roots(Vector* a, Vector d) {
  Vector a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3], a4 = a[4], a5 = a[5];
  for (int k = 0; k < kLinks; ++k) {
    a0 = root(a0 + d), a1 = root(a1 + d), a2 = root(a2 + d);
    a3 = root(a3 + d), a4 = root(a4 + d), a5 = root(a5 + d);
  }
  a[0] = a0, a[1] = a1, a[2] = a2, a[3] = a3, a[4] = a4, a[5] = a5;
}
SCREE_VECTORISED
void divide(Lanes* a) {
  divide_by_all(a, Lanes{} + 1.3);
}
SCREE_VECTORISED
void divide_single(TwinFloats* a) {
  divide_by_all(a, TwinFloats{} + 1.3f);
}
SCREE_VECTORISED
void take_roots(Lanes* a) {
  take_all_roots(a, Lanes{} + 3.0);
}
SCREE_VECTORISED
void take_single_roots(TwinFloats* a) {
  take_all_roots(a, TwinFloats{} + 3.0f);
}

struct Arithmetic {
  double flops;                         // additions and multiplications in equal numbers, 1/s
  double division, root;                // s, each of the four numbers in a vector
  double single_division, single_root;  // s, each of the eight in a vector
};

Arithmetic arithmetic(int threads) {
  const auto run = [&](auto number, auto&& kernel) {
    using Vector = decltype(number);
    return shortest([&] {
#pragma omp parallel num_threads(threads)
      {
        alignas(32) Vector a[2 * kChains];
        for (Vector& v : a) v = Vector{} + decltype(number[0] + number[0])(1.7);
        kernel(a);
        asm volatile("" ::"r"(a) : "memory");
      }
    });
  };
  const double links = 1.0 * kLinks * kChains * kLanes;  // of one thread
  return {
      threads * 2 * links / run(Lanes{}, [](Lanes* a) { add_and_multiply(a, a + kChains, 1e-9, 1 - 1e-9); }),
      run(Lanes{}, [](Lanes* a) { divide(a); }) / links,
      run(Lanes{}, [](Lanes* a) { take_roots(a); }) / links,
      run(TwinFloats{}, [](TwinFloats* a) { divide_single(a); }) / (2 * links),
      run(TwinFloats{}, [](TwinFloats* a) { take_single_roots(a); }) / (2 * links)};
}

// --- The step.

// How often things are there, for each sphere, and how long they take.
struct Step {
  int spheres;
  double contacts, pairs, mesh_contacts;  // a sphere
  double megabytes;                       // of the world
  double seconds;                         // a sphere and step, all of it
  double forces, moves;                   // s a sphere, the two loops alone, on the whole scene
};

Step measure(const Packing& packing) {
  const auto made = make_scene("lab", packing, {});
  auto& world = dynamic_cast<RrlinearWorld&>(*made);
  world.advance_to(0.02);  // contacts get their memory back
  const double before = world.statistics().particle_steps, start = processor_seconds();
  do {
    world.advance_to(world.time() + 0.002);
  } while (processor_seconds() - start < 2.0 && world.time() < 0.1);
  Step step{};
  step.seconds = (processor_seconds() - start) / (world.statistics().particle_steps - before);
  step.spheres = world.spheres().movable;
  step.megabytes = 1e-6 * static_cast<double>(world.bytes());
  FrozenStep frozen(world);
  const double n = step.spheres;
  step.contacts = frozen.pairs(0, frozen.blocks(), true) / n;
  step.pairs = frozen.pairs(0, frozen.blocks(), false) / n;
  for (int i = 0; i < step.spheres; ++i)
    step.mesh_contacts += static_cast<double>(world.mesh_contacts(i).size()) / n;
  const auto loop = [&](auto&& body) {
    return shortest([&] {
             for (int b = frozen.blocks(); b-- > 0;) body(b);
           }) /
           n;
  };
  step.forces = loop([&](int b) { frozen.forces(b); });
  step.moves = loop([&](int b) { frozen.move(b); });
  return step;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  std::string line;
  while (std::getline(in, line))
    if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
  return "unknown";
}

const char* instruction_set() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512vl")) return "AVX-512 (256 bits wide)";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
#endif
  return "base instruction set";
}

void print_counts() {
  const auto row = [](const char* what, const Operations& o) {
    fmt::print("  {:34}{:8}{:8}{:8}{:8}{:14}{:8}\n", what, o.adds, o.multiplications, o.divisions, o.roots,
               o.single_divisions, o.single_roots);
  };
  fmt::print(
      "\noperations                              adds   mults    divs   roots  single: divs   roots\n");
  row("contact: stiffness", kStiffness);
  row("contact: motion", kMotion);
  row("contact: two memories turned", kTurn);
  row("contact: law", kLaw);
  row("contact: moments and sums", kSums);
  row("contact, all", of_contact());
  row("open pair: sieve", kPair);
  row("sphere: leapfrog", kSphere);
  fmt::print("\nbytes                                                             read written\n");
  const auto rows = [](const char* of, const auto& table) {
    for (const Traffic& t : table)
      fmt::print("  {:60}{:8}{:8}\n", fmt::format("{}: {}", of, t.what), t.read, t.written);
  };
  rows("sphere", kOfSphere);
  rows("listed pair", kOfPair);
  rows("contact", kOfContact);
  rows("open pair", kOfOpenPair);
}

void print_limits(const Step& s, const Arithmetic& a, double l3, double memory) {
  const double moved = bytes(kOfSphere) + s.pairs * bytes(kOfPair) + s.contacts * bytes(kOfContact) +
                       (s.pairs - s.contacts) * bytes(kOfOpenPair);
  const Operations contact = of_contact(),
                   sphere = contact * s.contacts + kPair * (s.pairs - s.contacts) + kSphere;
  fmt::print(
      "\nlab, {} spheres, {:.1f} MB; a sphere has {:.2f} closed contacts, {:.2f} listed pairs, {:.2f} "
      "contacts "
      "with meshes (these are in the measured step, not in the limits); {:.0f} bytes a sphere and step\n",
      s.spheres, s.megabytes, s.contacts, s.pairs, s.mesh_contacts, moved);
  fmt::print(
      "\nlimit                        ns a contact   ns a sphere and step   measured / limit   two loops / "
      "limit\n");
  const auto row = [&](const char* what, double of_contact_s, double of_sphere_s) {
    fmt::print("  {:26}{:13.2f}{:23.2f}{:19.1f}{:20.1f}\n", what, 1e9 * of_contact_s, 1e9 * of_sphere_s,
               s.seconds / of_sphere_s, (s.forces + s.moves) / of_sphere_s);
  };
  // Shear and rolling share a vector: two numbers of a contact.
  const auto slow = [&](const Operations& o) {
    return o.divisions * a.division + o.roots * a.root +
           2 * (o.single_divisions * a.single_division + o.single_roots * a.single_root);
  };
  row("adds and multiplications", contact.flops() / a.flops, sphere.flops() / a.flops);
  row("divisions and roots", slow(contact), slow(sphere));
  row("bandwidth of L3", bytes(kOfContact) / l3, moved / l3);
  row("bandwidth of memory", bytes(kOfContact) / memory, moved / memory);
  fmt::print("measured, whole step        {:35.2f}\n", 1e9 * s.seconds);
  fmt::print("measured, contact_forces()  {:12.2f}{:23.2f}\n", 1e9 * s.forces / s.contacts, 1e9 * s.forces);
  fmt::print("measured, leapfrog()        {:35.2f}\n", 1e9 * s.moves);
}

void run(const std::string& file) {
  fmt::print("{}, {}\n", processor(), instruction_set());
  struct Set {
    const char* where;
    std::size_t bytes;
    bool shared;
  };
  const Set sets[] = {{"L2, 512 KiB a thread", 512 << 10, false},
                      {"L3, 8 MiB", 8 << 20, true},
                      {"memory, 512 MiB", 512 << 20, true}};
  double triads[3] = {};
  Arithmetic one{};
  const int most = omp_get_num_procs();
  for (int threads = 1; threads <= most; threads = threads < most ? most : most + 1) {
    fmt::print("\n{} thread{}                 copy GB/s  triad GB/s\n", threads, threads > 1 ? "s" : " ");
    for (int k = 0; k < 3; ++k) {
      const Bandwidth b = bandwidth(sets[k].bytes / (sets[k].shared ? threads : 1), threads);
      if (threads == 1) triads[k] = b.triad;
      fmt::print("  {:22}{:12.1f}{:12.1f}\n", sets[k].where, 1e-9 * b.copy, 1e-9 * b.triad);
    }
    const Arithmetic a = arithmetic(threads);
    if (threads == 1) one = a;
    fmt::print(
        "  adds and multiplications {:.1f} GFLOP/s; a division {:.3f} ns, a root {:.3f} ns, in single "
        "precision {:.3f} and {:.3f} ns\n",
        1e-9 * a.flops, 1e9 * a.division, 1e9 * a.root, 1e9 * a.single_division, 1e9 * a.single_root);
  }
  print_counts();
  print_limits(measure(file.empty() ? lab_packing(5.0, 0.60) : read_packing(file)), one, triads[1],
               triads[2]);
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  std::string file;
  CLI::App app("Measures the machine and says how far a step of scree is from its limits.");
  app.add_option("--packing", file,
                 "packing of the laboratory (scree_bench pack lab); none: 5 kg are settled first");
  CLI11_PARSE(app, argc, argv);
  try {
    scree::bench::run(file);
  } catch (const std::exception& e) {
    fmt::print(stderr, "scree_roofline: {}\n", e.what());
    return 2;
  }
}
