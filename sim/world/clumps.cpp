#include "sim/world/clumps.h"

#include <cmath>

#include "sim/world/step_kernels.h"

namespace scree {
namespace {

// Of a grain, which is alike all around its axis, kg m2.
struct Inertia {
  double along, across;
  Inertia(const Clumps::Inertia& of_unit, double mass, double radius)
      : along(of_unit.along * mass * radius * radius), across(of_unit.across * mass * radius * radius) {}
  Vec3 momentum(const Vec3& spin, const Vec3& axis) const {
    return across * spin + (along - across) * axis.dot(spin) * axis;
  }
  Vec3 spin(const Vec3& momentum, const Vec3& axis) const {
    return momentum / across + (1 / along - 1 / across) * axis.dot(momentum) * axis;
  }
};

// What local damping takes of a force.
Vec3 damping(const Vec3& f, const Vec3& v, double alpha) {
  Vec3 d;
  for (int k = 0; k < 3; ++k) d[k] = f[k] - locally_damped(f[k], v[k], alpha);
  return d;
}

Vec3 turned(const Vec3& v, const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Vec3(Eigen::AngleAxisd(angle, turn / angle) * v) : v;
}

}  // namespace

double Clumps::size() const {
  return 1 / std::cbrt(1 + 1.5 * elongation - 0.5 * elongation * elongation * elongation);
}

Clumps::Inertia Clumps::inertia() const {
  const double e = elongation, e2 = e * e, e3 = e2 * e, e5 = e3 * e2, volume = 2. / 3 + e - e3 / 3;
  const double along = (8. / 15 + e - 2 * e3 / 3 + e5 / 5) / (2 * volume);
  const double out2 = 2. / 15 + e3 / 3 - e5 / 5 + e * (0.5 - e2 + e2 * e2 / 2) + e2 * (2. / 3 + e - e3 / 3);
  return {along, along / 2 + out2 / volume};
}

Vec3 clump_angular_momentum(const Clumps& clumps, const Vec3& spin, const Vec3& axis, double mass,
                            double radius) {
  return Inertia(clumps.inertia(), mass, radius).momentum(spin, axis);
}

ClumpSpheres spheres_of_clump(const Clumps& clumps, const NewSphere& grain, double mass) {
  ClumpSpheres two;
  two.diameter = clumps.size() * grain.diameter;
  const double r = 0.5 * two.diameter, arm = clumps.elongation * r;
  const Vec3 axis = grain.axis.squaredNorm() > 0 ? grain.axis : Vec3::UnitX();
  for (int k = 0; k < 2; ++k) {
    const Vec3 out = (k == 0 ? -arm : arm) * axis;
    two.place[k] = grain.position + out;
    two.velocity[k] = grain.velocity + grain.spin.cross(out);
  }
  two.angular_momentum = clump_angular_momentum(clumps, grain.spin, axis, mass, r);
  return two;
}

void move_clumps(const LeapfrogView& view, const Clumps& clumps, BlockWork& work) {
  Spheres& s = view.spheres;
  const double dt = view.dt;
  const Clumps::Inertia of_unit = clumps.inertia();
  double damped = 0;
  const auto look = [&](int i) {
    if (const double out2 = view.pairs.way_out2(i, s.place[i]); out2 > PairList::kNearRim2) {
      work.near_rim.push_back(i);
      work.left_ball = work.left_ball || out2 > 1;
    }
  };
  for (const int i : work.awake) {
    const int p = s.partner[i];
    if (p < i) continue;
    const double mass = s.velocity[i].w + s.velocity[p].w, radius = s.place[i].w,
                 length = clumps.elongation * radius;
    const Inertia inertia(of_unit, mass, radius);
    const Vec3 x0 = s.place[i].vec(), x1 = s.place[p].vec(), arm = 0.5 * (x1 - x0), middle = 0.5 * (x0 + x1);
    const Vec3 v = 0.5 * (s.velocity[i].vec() + s.velocity[p].vec()), w = s.spin[i].vec();
    const ForceSum &a = view.sum[i], &b = view.sum[p];
    const Vec3 force = a.force.vec() + b.force.vec() + mass * view.gravity,
               torque = a.torque.vec() + b.torque.vec() + arm.cross(b.force.vec() - a.force.vec());
    const double alpha = a.force.w + b.force.w > 0 ? view.alpha : view.alpha_in_flight;
    const Vec3 shift_damping = damping(force, v, alpha), turn_damping = damping(torque, w, alpha);

    const Vec3 v_then = v + dt / mass * (force - shift_damping);
    const Vec3 momentum = s.angular[i].vec() + dt * (torque - turn_damping);
    const Vec3 axis = arm / length;
    const Vec3 half_way = (axis + 0.5 * dt * inertia.spin(momentum, axis).cross(axis)).normalized();
    const Vec3 w_then = inertia.spin(momentum, half_way);
    Vec3 arm_then = turned(arm, dt * w_then);
    arm_then *= length / arm_then.norm();  // against rounding
    damped += shift_damping.dot(v + v_then) + turn_damping.dot(w + w_then);
    work.momentum += 0.5 * mass * (v + v_then);

    const Vec3 middle_then = middle + dt * v_then, swing = (arm_then - arm) / dt;
    s.place[i].set(middle_then - arm_then);
    s.place[p].set(middle_then + arm_then);
    s.velocity[i].set(v_then - swing);
    s.velocity[p].set(v_then + swing);
    for (const int k : {i, p}) {
      s.spin[k].set(w_then);
      s.angular[k].set(momentum);
      look(k);
    }
  }
  work.losses.local_damping += 0.5 * dt * damped;
}

}  // namespace scree
