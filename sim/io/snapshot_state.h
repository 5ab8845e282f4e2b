#pragma once
// Snapshots in checkpoints: every member.
#include "sim/io/snapshot.h"
#include "sim/io/state_stream.h"

namespace scree {

template <class Stream>
void state(Stream& stream, Grain& g) {
  stream(g.id, g.position, g.velocity, g.diameter, g.mass, g.dump);
}

template <class Stream>
void state(Stream& stream, Snapshot& s) {
  stream(s.time, s.grains);
}

}  // namespace scree
