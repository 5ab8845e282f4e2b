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

  /// Contacts of one sphere; the first with body -1 ends them.
  using Contacts = std::array<MeshContact, kMeshContactSlots>;

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
  /// Number of contacts of a sphere with meshes, and the contacts.
  int count(int i) const { return closed_[i]; }
  const MeshContact& contact(int i, int k) const {
    return k == 0 ? first_[at(i)] : others_[at(i)][static_cast<std::size_t>(k) - 1];
  }
  void load(int i, Contacts& contacts) const {
    for (int k = 0; k < closed_[i]; ++k) contacts[static_cast<std::size_t>(k)] = contact(i, k);
    if (closed_[i] < kMeshContactSlots) contacts[closed_[i]].body = -1;
  }
  void store(int i, const Contacts& contacts);
  /// Brings what a step needs of a sphere that has facets nearer to the processor.
  void fetch(int i) const {
    if (closed_[i] > 0) {
      const char* const first = reinterpret_cast<const char*>(&first_[at(i)]);
      __builtin_prefetch(first, 1);
      __builtin_prefetch(first + sizeof(MeshContact) - 1, 1);
    }
    __builtin_prefetch(rows_.begin(i));
  }
  int rows() const { return static_cast<int>(slot_of_.size()); }
  /// Spheres that have facets of a mesh that moves (or will), rising.
  std::vector<int> near_tools(const Meshes& meshes, double time) const;
  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream);
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
  // By slot; the first is nobody's. Most spheres that touch a mesh have one contact: those lie side by side.
  std::vector<MeshContact> first_{1};
  std::vector<std::array<MeshContact, kMeshContactSlots - 1>> others_{1};
  std::vector<int> free_slots_;
  double tool_skin_ = 0;
  std::vector<FacetRef> row_;
  std::vector<int> found_;
};

}  // namespace scree
