#pragma once
// Grains that are no spheres: two equal spheres, rigidly joined. Contacts are those of the spheres; the grain
// moves by the sum of their forces and by the moment about its middle. It is a body of one density that fills
// the union of the two spheres, each half of it half of the mass.
//
// One step: forces on both spheres at x(t); V(t + dt/2) of the middle and L(t + dt/2), angular momentum about
// it in world axes, by leapfrog with local damping of the grain's force and moment; spin from L with the axis
// of t + dt/2; the axis turns by spin dt, exactly; velocities of the spheres are the ways that they make over
// dt, as their contacts' memory wants them. Angular momentum of a grain in flight is kept to rounding.
#include "sim/material/vector.h"

namespace scree {

struct Spheres;
struct NewSphere;
struct LeapfrogView;
struct BlockWork;

struct Clumps {
  /// Distance of the middles of the two spheres over the diameter of one, 0 to 1; 0: grains are spheres. A
  /// grain is 1 + elongation times as long as it is thick. Also the distance of a sphere's middle from the
  /// grain's over the sphere's radius.
  double elongation = 0;

  bool on() const { return elongation > 0; }
  /// Of one grain.
  int spheres() const { return on() ? 2 : 1; }
  /// Diameter of one of the spheres over that of the grain (a sphere of its volume): with the volume of two
  /// spheres less their common lens, (1 + 1.5 e - 0.5 e^3)^(-1/3).
  double size() const;
  /// Length of a grain over its diameter.
  double length() const { return (1 + elongation) * size(); }

  /// Moments of inertia of the union about its middle over mass and square of a sphere's radius: along the
  /// axis and across it. With slices pi (1 - u^2) of a half, u from -e to 1, at e + u from the middle:
  /// volume V = 2/3 + e - e^3/3, along (8/15 + e - 2 e^3/3 + e^5/5) / (2 V), across along / 2 +
  /// (2/15 + e^3/3 - e^5/5 + e (1/2 - e^2 + e^4/2) + e^2 (2/3 + e - e^3/3)) / V.
  struct Inertia {
    double along, across;
  };
  Inertia inertia() const;
};

/// The two spheres of a grain with an axis (a unit vector; zero: along x); the grain's number stays with the
/// first.
struct ClumpSpheres {
  Vec3 place[2], velocity[2];
  double diameter;        ///< m, of each
  Vec3 angular_momentum;  ///< kg m2/s, of the grain about its middle
};
ClumpSpheres spheres_of_clump(const Clumps& clumps, const NewSphere& grain, double mass);

/// Angular momentum (kg m2/s) of a clump about its middle: spin (rad/s), axis (a unit vector), mass of the
/// grain (kg), radius of one of its spheres (m).
Vec3 clump_angular_momentum(const Clumps& clumps, const Vec3& spin, const Vec3& axis, double mass,
                            double radius);

/// Moves the clumps whose first sphere is one of the block's awake by one step, after leapfrog(); finds those
/// near the rim of their balls.
void move_clumps(const LeapfrogView& view, const Clumps& clumps, BlockWork& work);

}  // namespace scree
