#pragma once
// Facets that a sphere touches or soon may, cached like pairs, and the memory of its contacts with them.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sim/world/mesh_contact.h"
#include "sim/world/pair_list.h"
#include "sim/world/rows.h"
#include "sim/world/spheres.h"

namespace scree {

class FacetList {
 public:
  using Meshes = std::vector<std::unique_ptr<MeshBody>>;

  /// Contacts of one sphere: those that are closed first.
  struct Slots {
    std::array<MeshContact, kMeshContactSlots> contacts;
    std::int64_t unused = 0;  // keeps groups from lying at the same place of every cache page
  };

  /// Facets of tools are listed this much further out (m), and anew when one has moved by as much.
  void set_tool_skin(double skin) { tool_skin_ = skin; }
  double tool_skin() const { return tool_skin_; }

  /// After spheres were re-sorted or added: contact memory follows; nothing is listed until list() is called.
  /// Frees the contacts with meshes that are gone, and returns 1 for the spheres that had one.
  std::vector<std::uint8_t> renumber(const std::vector<int>& order, const Spheres& spheres,
                                     const Meshes& meshes);
  /// Lists the facets near some spheres anew and, if `tools_moved`, those of moving meshes near all.
  void list(std::span<const int> listed, bool tools_moved, const Spheres& spheres, const PairList& pairs,
            const Meshes& meshes);
  void list_all(const Spheres& spheres, const PairList& pairs, const Meshes& meshes);

  bool any(int i) const { return slot_of_[i] >= 0; }
  std::span<const FacetRef> facets(int i) const { return rows_.row(i); }
  /// The contacts of a sphere with meshes.
  std::span<MeshContact> contacts(int i) {
    return {slots_[at(i)].contacts.data(), static_cast<std::size_t>(closed_[i])};
  }
  std::span<const MeshContact> contacts(int i) const {
    return {slots_[at(i)].contacts.data(), static_cast<std::size_t>(closed_[i])};
  }
  /// Finds the contacts of a sphere that has facets (see update_mesh_contacts()).
  MeshContactChanges update(int i, const Quad& place, const Meshes& meshes, Slots& open);
  /// Brings what a step needs of a sphere that has facets nearer to the processor.
  void fetch(int i) const {
    if (closed_[i] > 0) {
      const char* const slots = reinterpret_cast<const char*>(&slots_[at(i)]);
      for (std::size_t k = 0; k < 2 * sizeof(MeshContact); k += 64) __builtin_prefetch(slots + k, 1);
    }
    __builtin_prefetch(rows_.begin(i));
  }
  int rows() const { return static_cast<int>(slot_of_.size()); }
  /// Spheres that have facets of a mesh that moves (or will), rising.
  std::vector<int> near_tools(const Meshes& meshes, double time) const;
  /// Bytes held.
  std::size_t bytes() const;

 private:
  void list_one(int i, bool anew, const Spheres& spheres, const PairList& pairs, const Meshes& meshes);
  void find_boxes(bool tools_moved, const Meshes& meshes);
  void set_slot(int i, bool needed);

  struct Box {
    int body;
    bool moves;
    Vec3 low, high;  // m, world
  };
  std::vector<Box> boxes_;
  Rows<FacetRef> rows_;
  std::size_t at(int i) const { return slot_of_[i] < 0 ? 0 : static_cast<std::size_t>(slot_of_[i]); }

  std::vector<int> slot_of_;          // of a sphere that has facets, or -1
  std::vector<std::uint8_t> closed_;  // number of contacts of a sphere
  std::vector<Slots> slots_{1};       // the first is nobody's
  std::vector<int> free_slots_;
  double tool_skin_ = 0;
  std::vector<FacetRef> row_;
  std::vector<int> found_;
};

}  // namespace scree
