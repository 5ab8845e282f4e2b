// The scenes of the comparison in stock Bullet: rigid spheres, sequential impulse solver, nothing sleeps.
//   bullet SCENE PACKING.csv STEP SECONDS BUDGET_CPU_S END.csv
// prints one line of JSON. SCENE: lab or field. STEP: s. The budget stops the run early.
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <btBulletDynamicsCommon.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace {

constexpr double kDensity = 2760.0, kPi = 3.14159265358979323846;
constexpr double kRestitution = 0.6547;  // sqrt((1 - 0.4) / (1 + 0.4)): loses as much as local damping of 0.4
constexpr double kBucketRadius = 0.175, kBucketHeight = 0.60, kLift = 0.5;
constexpr int kFacets = 64, kIterations = 10;

double mu_r = 0;

double cpu_seconds() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return u.ru_utime.tv_sec + u.ru_stime.tv_sec + 1e-6 * (u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Ball {
  double x, y, z, d;
  int fixed;
};

double radius_of(const btCollisionObject* o) {
  const btCollisionShape* s = o->getCollisionShape();
  return s->getShapeType() == SPHERE_SHAPE_PROXYTYPE ? static_cast<const btSphereShape*>(s)->getRadius()
                                                     : 0.0;
}

// Bullet's rolling friction is a length: mu_r Rbar, with Rbar = R1 on walls.
btScalar rolling_friction(const btCollisionObject* a, const btCollisionObject* b) {
  const double r1 = radius_of(a), r2 = radius_of(b);
  if (r1 == 0 || r2 == 0) return static_cast<btScalar>(mu_r * (r1 + r2));
  return static_cast<btScalar>(mu_r * r1 * r2 / (r1 + r2));
}

struct Lift : btMotionState {
  double speed = 0, time = 0;
  void getWorldTransform(btTransform& t) const override {
    t.setIdentity();
    t.setOrigin(btVector3(0, 0, static_cast<btScalar>(speed * time)));
  }
  void setWorldTransform(const btTransform&) override {}
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr, "bullet SCENE PACKING.csv STEP SECONDS BUDGET_CPU_S END.csv\n");
    return 2;
  }
  const bool lab = std::string(argv[1]) == "lab";
  const double step = std::atof(argv[3]), seconds = std::atof(argv[4]), budget = std::atof(argv[5]);
  const double scale = lab ? 20.0 : 1.0;  // Bullet's margins are made for things of about 1 unit
  const double mu = lab ? 0.2 : 0.44;
  mu_r = mu;

  std::vector<Ball> balls;
  std::FILE* in = std::fopen(argv[2], "r");
  if (!in) return std::fprintf(stderr, "%s: cannot be read\n", argv[2]), 2;
  char line[256];
  while (std::fgets(line, sizeof line, in)) {
    Ball b{};
    if (std::sscanf(line, "%lf,%lf,%lf,%lf,%d", &b.x, &b.y, &b.z, &b.d, &b.fixed) == 5) balls.push_back(b);
  }
  std::fclose(in);

  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 131072;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 131072;
  btDefaultCollisionConfiguration configuration(info);
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, static_cast<btScalar>(-9.81 * scale)));
  world.getSolverInfo().m_numIterations = kIterations;
  world.getSolverInfo().m_restitutionVelocityThreshold = static_cast<btScalar>(0.2 * scale);
  gCalculateCombinedRollingFrictionCallback = rolling_friction;

  const auto dress = [&](btRigidBody& body) {
    body.setFriction(static_cast<btScalar>(std::sqrt(mu)));  // Bullet multiplies the two
    body.setRollingFriction(1);
    body.setRestitution(static_cast<btScalar>(std::sqrt(kRestitution)));
    body.setActivationState(DISABLE_DEACTIVATION);
  };
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  int moving = 0;
  for (const Ball& b : balls) {
    const double r = 0.5 * b.d, mass = b.fixed ? 0.0 : kDensity * 4.0 / 3.0 * kPi * r * r * r;
    shapes.push_back(std::make_unique<btSphereShape>(static_cast<btScalar>(scale * r)));
    btVector3 inertia(0, 0, 0);
    if (!b.fixed) shapes.back()->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo ci(static_cast<btScalar>(mass), nullptr, shapes.back().get(),
                                                inertia);
    ci.m_startWorldTransform.setIdentity();
    ci.m_startWorldTransform.setOrigin(btVector3(static_cast<btScalar>(scale * b.x),
                                                 static_cast<btScalar>(scale * b.y),
                                                 static_cast<btScalar>(scale * b.z)));
    bodies.push_back(std::make_unique<btRigidBody>(ci));
    dress(*bodies.back());
    world.addRigidBody(bodies.back().get());
    moving += !b.fixed;
  }
  const auto add_static = [&](std::unique_ptr<btCollisionShape> shape, btMotionState* motion, double z = 0) {
    shapes.push_back(std::move(shape));
    btRigidBody::btRigidBodyConstructionInfo ci(0, motion, shapes.back().get());
    ci.m_startWorldTransform.setIdentity();
    ci.m_startWorldTransform.setOrigin(btVector3(0, 0, static_cast<btScalar>(z)));
    bodies.push_back(std::make_unique<btRigidBody>(ci));
    dress(*bodies.back());
    if (motion)
      bodies.back()->setCollisionFlags(bodies.back()->getCollisionFlags() |
                                       btCollisionObject::CF_KINEMATIC_OBJECT);
    world.addRigidBody(bodies.back().get());
  };
  btTriangleMesh tube;
  Lift lift;
  // A box, not a plane: a plane is a possible partner of every sphere.
  add_static(std::make_unique<btBoxShape>(btVector3(100, 100, 10)), nullptr, -10);
  if (lab) {
    lift.speed = kLift * scale;
    const auto corner = [&](int k, double z) {
      const double a = 2 * kPi * k / kFacets;
      return btVector3(static_cast<btScalar>(scale * kBucketRadius * std::cos(a)),
                       static_cast<btScalar>(scale * kBucketRadius * std::sin(a)),
                       static_cast<btScalar>(scale * z));
    };
    for (int k = 0; k < kFacets; ++k) {
      tube.addTriangle(corner(k, 0), corner(k + 1, 0), corner(k + 1, kBucketHeight));
      tube.addTriangle(corner(k, 0), corner(k + 1, kBucketHeight), corner(k, kBucketHeight));
    }
    auto shape = std::make_unique<btBvhTriangleMeshShape>(&tube, true);
    shape->setMargin(btScalar(0.01));
    add_static(std::move(shape), &lift);
  } else {
    const btScalar h = static_cast<btScalar>(std::sqrt(0.5));
    add_static(std::make_unique<btStaticPlaneShape>(btVector3(h, 0, h), 14 * h), nullptr);
  }

  const long steps = std::lround(seconds / step);
  const double cpu = cpu_seconds(), wall = wall_seconds();
  long done = 0;
  while (done < steps && (done % 10 != 0 || cpu_seconds() - cpu < budget)) {
    lift.time = (done + 1) * step;
    world.stepSimulation(static_cast<btScalar>(step), 1, static_cast<btScalar>(step));
    ++done;
  }
  const double cpu_used = cpu_seconds() - cpu, wall_used = wall_seconds() - wall;

  std::FILE* out = std::fopen(argv[6], "w");
  std::fprintf(out, "x_m,y_m,z_m,diameter_m,fixed\n");
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const btVector3& p = bodies[k]->getWorldTransform().getOrigin();
    if (!balls[k].fixed)
      std::fprintf(out, "%.6g,%.6g,%.6g,%.6g,0\n", p.x() / scale, p.y() / scale, p.z() / scale, balls[k].d);
  }
  std::fclose(out);
  std::printf("{\"particles\": %d, \"steps\": %ld, \"cpu_s\": %.3f, \"wall_s\": %.3f}\n", moving, done,
              cpu_used, wall_used);
  std::fflush(nullptr);
  std::_Exit(0);  // taking bodies out one by one takes seconds
}
