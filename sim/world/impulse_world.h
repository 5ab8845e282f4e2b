#pragma once
// The second engine: Bullet's sequential-impulse solver on the same scene.
//
// Friction and rolling friction are given in place of the material's mu and mu_r, combined per contact: the
// rolling coefficient of Bullet is a length, so it is multiplied by the effective radius of the pair. Bullet
// limits a rolling impulse at min(c lambda, c), which is right only while the normal impulse lambda is below
// 1; masses are therefore given to Bullet in units of kMassUnit. Local damping takes alpha |dv| from every
// component of the change of velocity of a step, never reversing the motion. Nothing sleeps.
//
// Bullet pushes overlapping spheres apart by velocities that a step later are gone again: a pile at rest
// shows centimetres a second. How fast a sphere moves is therefore told by how far it came within kWindow.
#include "sim/world/rock_world.h"

namespace scree {

class ImpulseWorld final : public RockWorld {
 public:
  explicit ImpulseWorld(const WorldSettings& settings);
  void advance_to(double time) override;
  double speed_of(int sphere) const override;

 protected:
  void scene_changed() override { changed_ = true; }
  bool bullet_moves_spheres() const override { return true; }
  void sphere_lost(int) override { changed_ = true; }
  void integrateTransforms(btScalar dt) override;

 private:
  void prepare();
  void read_back();
  void look_how_far();
  bool changed_ = true;
  double looked_ = 0;                    // s, when the places below were taken
  std::vector<Vec3> places_;             // by id, m
  std::vector<double> travelled_speed_;  // by id, m/s, over the last window
  std::vector<int> movable_;             // indices
};

}  // namespace scree
