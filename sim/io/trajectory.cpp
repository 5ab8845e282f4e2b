#include "sim/io/trajectory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "sim/io/h5_file.h"
#include "sim/io/text_file.h"
#include "sim/io/undo_file.h"

namespace scree {
namespace {

std::vector<float> positions_of(const std::vector<Grain>& grains) {
  std::vector<float> out;
  out.reserve(3 * grains.size());
  for (const Grain& grain : grains)
    for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(grain.position[axis]));
  return out;
}

template <typename T, typename Field>
std::vector<T> column(const std::vector<Grain>& grains, Field field) {
  std::vector<T> out;
  out.reserve(grains.size());
  for (const Grain& grain : grains) out.push_back(static_cast<T>(grain.*field));
  return out;
}

std::string xdmf_item(const std::string& file, const std::string& path, const std::string& size,
                      const char* type, int bytes) {
  return fmt::format(
      R"(<DataItem Dimensions="{}" NumberType="{}" Precision="{}" Format="HDF">{}:{}</DataItem>)", size, type,
      bytes, file, path);
}

/// One frame of a growing data set, chosen by start, stride and count.
std::string xdmf_frame(const std::string& file, const std::string& path, std::size_t frame,
                       std::size_t frames, std::size_t rows, int width) {
  const std::string size = width == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, width);
  const std::string slab = width == 1 ? fmt::format("{} 0 1 1 1 {}", frame, rows)
                                      : fmt::format("{} 0 0 1 1 1 1 {} {}", frame, rows, width);
  return fmt::format(R"(<DataItem ItemType="HyperSlab" Dimensions="1 {}">
          <DataItem Dimensions="3 {}" Format="XML" NumberType="Int">{}</DataItem>
          {}
        </DataItem>)",
                     size, width == 1 ? 2 : 3, slab,
                     xdmf_item(file, path, fmt::format("{} {}", frames, size), "Float", 4));
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string xdmf_attribute(const char* name, const char* type, const std::string& item) {
  return fmt::format(
      "      <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n        {}\n      </Attribute>\n",
      name, type, item);
}

}  // namespace

struct TrajectoryWriter::Files {
  Files(const std::filesystem::path& path, const std::vector<Grain>& all, const std::vector<Grain>& base,
        const TrajectoryInfo& info)
      : file(path), h5(path), rows(all.size()), base_rows(base.size()) {
    place = positions_of(all);
    number_rows(all);
    measure_box(all, base);
    create_head(info);
    create_rock(all);
    if (base_rows > 0) create_base(base);
    h5.flush();
    xyz.open(xyz_file(), std::ios::binary | std::ios::trunc);
    if (!xyz) fail_to_write(xyz_file(), std::strerror(errno));
    write_xdmf();
  }

  Files(const std::filesystem::path& path, const std::vector<Grain>& all, StateReader& saved)
      : file(path), h5(path, false), rows(all.size()) {
    state(saved);
    if (place.size() != 3 * rows) throw StateError("saved state: its trajectory has other grains");
    number_rows(all);
    step = h5.dataset("/particles/rock/position/step");
    time = h5.dataset("/particles/rock/position/time");
    position = h5.dataset("/particles/rock/position/value");
    velocity = h5.dataset("/particles/rock/velocity/value");
    diameter = h5.dataset("/particles/rock/diameter/value");
    for (const H5Handle* growing : {&position, &velocity}) h5.cut(*growing, times.size(), {rows, 3});
    h5.cut(diameter, times.size(), {rows});
    for (const H5Handle* growing : {&step, &time}) h5.cut(*growing, times.size(), {});
    h5.flush();
    std::error_code error;
    const std::uint64_t there = std::filesystem::file_size(xyz_file(), error);
    if (!error && there < xyz_size) error = std::make_error_code(std::errc::no_such_file_or_directory);
    if (!error) std::filesystem::resize_file(xyz_file(), xyz_size, error);
    if (error) fail_to_write(xyz_file(), error.message());
    xyz.open(xyz_file(), std::ios::binary | std::ios::app);
    if (!xyz) fail_to_write(xyz_file(), std::strerror(errno));
    write_xdmf();
  }

  template <class Stream>
  void state(Stream& stream) {
    stream.section("trajectory", 1);
    stream(times, place, xyz_size, base_rows, low, edges);
  }

  void save(StateWriter& writer) {
    h5.mark();
    if (const int text = open(xyz_file().c_str(), O_WRONLY | O_CLOEXEC); text >= 0) {
      fdatasync(text);
      ::close(text);
    }
    state(writer);
  }

  std::filesystem::path xyz_file() const { return std::filesystem::path(file).replace_extension(".xyz"); }
  std::filesystem::path xdmf_file() const { return std::filesystem::path(file).replace_extension(".xdmf"); }

  void number_rows(const std::vector<Grain>& all) {
    dump = column<std::int32_t>(all, &Grain::dump);
    for (std::size_t row = 0; row < rows; ++row)
      if (!row_of.emplace(all[row].id, row).second)
        throw std::invalid_argument(fmt::format("trajectory: id {} occurs twice", all[row].id));
  }

  void measure_box(const std::vector<Grain>& all, const std::vector<Grain>& base) {
    Vec3 high = Vec3::Constant(std::numeric_limits<double>::lowest());
    low = -high;
    for (const auto* grains : {&all, &base})
      for (const Grain& grain : *grains) {
        low = low.cwiseMin(grain.position - Vec3::Constant(grain.diameter / 2));
        high = high.cwiseMax(grain.position + Vec3::Constant(grain.diameter / 2));
      }
    edges = high - low;
  }

  void create_head(const TrajectoryInfo& info) {
    const H5Handle head = h5.group("h5md");
    h5.attribute(head, "version", std::vector<int>{1, 1});
    h5.attribute(h5.group(head, "author"), "name", info.author);
    const H5Handle creator = h5.group(head, "creator");
    h5.attribute(creator, "name", "scree");
    h5.attribute(creator, "version", info.version);
    const H5Handle modules = h5.group(head, "modules");
    const H5Handle units = h5.group(modules, "units");
    h5.attribute(units, "version", std::vector<int>{1, 0});
    h5.attribute(units, "system", "SI");
    const H5Handle parameters = h5.group("parameters");
    h5.fixed(parameters, "seed", H5T_NATIVE_UINT64, {}, &info.seed);
    if (!info.scenario.empty()) h5.text(parameters, "scenario", info.scenario);
  }

  void create_box(hid_t group) {
    const H5Handle box = h5.group(group, "box");
    h5.attribute(box, "dimension", std::vector<int>{3});
    h5.repeated_attribute(box, "boundary", "none", 3);
    h5.attribute(h5.fixed(box, "edges", H5T_NATIVE_DOUBLE, {3}, edges.data()), "unit", "m");
  }

  void create_rock(const std::vector<Grain>& all) {
    const H5Handle particles = h5.group("particles");
    const H5Handle rock = h5.group(particles, "rock");
    create_box(rock);
    h5.fixed(rock, "id", H5T_NATIVE_INT64, {rows}, column<std::int64_t>(all, &Grain::id).data());
    h5.attribute(h5.fixed(rock, "mass", H5T_NATIVE_DOUBLE, {rows}, column<double>(all, &Grain::mass).data()),
                 "unit", "kg");
    h5.fixed(rock, "dump", H5T_NATIVE_INT32, {rows}, dump.data());
    h5.fixed(rock, "species", H5T_NATIVE_INT32, {rows}, std::vector<std::int32_t>(rows, 1).data());

    const H5Handle first = h5.group(rock, "position");
    step = h5.growing(first, "step", H5T_NATIVE_INT64, {}, false);
    time = h5.growing(first, "time", H5T_NATIVE_DOUBLE, {}, false);
    h5.attribute(time, "unit", "s");
    position = h5.growing(first, "value", H5T_NATIVE_FLOAT, {rows, 3}, true);
    h5.attribute(position, "unit", "m");
    // H5MD lets elements that are sampled together share step and time.
    const auto element = [&](const char* name, const std::vector<hsize_t>& row, const char* unit) {
      const H5Handle group = h5.group(rock, name);
      h5.link(first, group, "step");
      h5.link(first, group, "time");
      H5Handle value = h5.growing(group, "value", H5T_NATIVE_FLOAT, row, true);
      h5.attribute(value, "unit", unit);
      return value;
    };
    velocity = element("velocity", {rows, 3}, "m s-1");
    diameter = element("diameter", {rows}, "m");
  }

  void create_base(const std::vector<Grain>& base) {
    const H5Handle group = h5.group("/particles/base");
    create_box(group);
    h5.attribute(h5.fixed(group, "position", H5T_NATIVE_FLOAT, {base_rows, 3}, positions_of(base).data()),
                 "unit", "m");
    h5.attribute(h5.fixed(group, "diameter", H5T_NATIVE_FLOAT, {base_rows},
                          column<float>(base, &Grain::diameter).data()),
                 "unit", "m");
  }

  void write_h5(const Snapshot& snapshot, std::int64_t step_number) {
    std::vector<float> speeds(3 * rows, 0.0F), sizes(rows, 0.0F);
    for (const Grain& grain : snapshot.grains) {
      const auto found = row_of.find(grain.id);
      if (found == row_of.end())
        throw std::invalid_argument(fmt::format("trajectory: id {} was not announced", grain.id));
      const std::size_t row = found->second;
      for (int axis = 0; axis < 3; ++axis) {
        place[3 * row + static_cast<std::size_t>(axis)] = static_cast<float>(grain.position[axis]);
        speeds[3 * row + static_cast<std::size_t>(axis)] = static_cast<float>(grain.velocity[axis]);
      }
      sizes[row] = static_cast<float>(grain.diameter);
    }
    const hsize_t frame = times.size();
    h5.append(position, H5T_NATIVE_FLOAT, frame, {rows, 3}, place.data());
    h5.append(velocity, H5T_NATIVE_FLOAT, frame, {rows, 3}, speeds.data());
    h5.append(diameter, H5T_NATIVE_FLOAT, frame, {rows}, sizes.data());
    h5.append(time, H5T_NATIVE_DOUBLE, frame, {}, &snapshot.time);
    h5.append(step, H5T_NATIVE_INT64, frame, {}, &step_number);
    h5.flush();
  }

  void write_xyz(const Snapshot& snapshot, std::int64_t step_number) {
    const auto count = std::count_if(snapshot.grains.begin(), snapshot.grains.end(),
                                     [](const Grain& grain) { return grain.diameter > 0; });
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}\nLattice=\"{:.9g} 0 0 0 {:.9g} 0 0 0 {:.9g}\" Origin=\"{:.9g} {:.9g} {:.9g}\" pbc=\"F F F\" "
        "Properties=species:S:1:pos:R:3:radius:R:1:id:I:1:dump:I:1:velo:R:3 Time={:.9g} Step={}\n",
        count, edges.x(), edges.y(), edges.z(), low.x(), low.y(), low.z(), snapshot.time, step_number);
    for (const Grain& grain : snapshot.grains) {
      if (!(grain.diameter > 0)) continue;
      const Vec3 &p = grain.position, &v = grain.velocity;
      const std::int32_t dump_number = dump[row_of.at(grain.id)];
      fmt::format_to(out, "Rock {:.7g} {:.7g} {:.7g} {:.7g} {} {} {:.5g} {:.5g} {:.5g}\n", p.x(), p.y(),
                     p.z(), grain.diameter / 2, grain.id, dump_number, v.x(), v.y(), v.z());
    }
    xyz.write(text.data(), static_cast<std::streamsize>(text.size()));
    xyz.flush();
    if (!xyz) fail_to_write(xyz_file(), std::strerror(errno));
    xyz_size += text.size();
  }

  /// ParaView's form: a collection over time, and the fixed balls beside it.
  void write_xdmf() const {
    const std::string name = xml_escaped(file.filename().string());
    const std::string size = fmt::format("{}", rows);
    std::string text =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
        "  <Grid Name=\"rock\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
      const auto slab = [&](const char* field, int width) {
        return xdmf_frame(name, fmt::format("/particles/rock/{}/value", field), frame, times.size(), rows,
                          width);
      };
      text += fmt::format(
          "    <Grid Name=\"rock\" GridType=\"Uniform\">\n      <Time Value=\"{:.9g}\"/>\n"
          "      <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\"/>\n"
          "      <Geometry GeometryType=\"XYZ\">\n        {}\n      </Geometry>\n",
          times[frame], rows, slab("position", 3));
      text += xdmf_attribute("diameter", "Scalar", slab("diameter", 1));
      text += xdmf_attribute("velocity", "Vector", slab("velocity", 3));
      text += xdmf_attribute("dump", "Scalar", xdmf_item(name, "/particles/rock/dump", size, "Int", 4));
      text += "    </Grid>\n";
    }
    text += "  </Grid>\n";
    if (base_rows > 0) {
      text += fmt::format(
          "  <Grid Name=\"base\" GridType=\"Uniform\">\n"
          "      <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{0}\"/>\n"
          "      <Geometry GeometryType=\"XYZ\">\n        {1}\n      </Geometry>\n",
          base_rows, xdmf_item(name, "/particles/base/position", fmt::format("{} 3", base_rows), "Float", 4));
      text += xdmf_attribute(
          "diameter", "Scalar",
          xdmf_item(name, "/particles/base/diameter", fmt::format("{}", base_rows), "Float", 4));
      text += "  </Grid>\n";
    }
    write_text_file(xdmf_file(), text + "</Domain>\n</Xdmf>\n");
  }

  void close() {
    for (H5Handle* handle : {&step, &time, &position, &velocity, &diameter}) handle->reset();
    h5.close();
    xyz.close();
  }

  std::filesystem::path file;
  H5File h5;
  std::uint64_t rows, base_rows = 0;
  Vec3 low = Vec3::Zero(),
       edges = Vec3::Zero();  // box around all future places; nominal, as the model is open
  std::unordered_map<std::int64_t, std::size_t> row_of;
  std::vector<float> place;
  std::vector<std::int32_t> dump;
  std::vector<double> times;
  H5Handle step, time, position, velocity, diameter;
  std::ofstream xyz;
  std::uint64_t xyz_size = 0;  // bytes
};

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& h5_file, const std::vector<Grain>& all,
                                   const std::vector<Grain>& base, const TrajectoryInfo& info) {
  if (all.empty()) throw std::invalid_argument("trajectory: there are no grains");
  ask_for_memory();
  const QuietHdf5 quiet;
  files_ = std::make_unique<Files>(h5_file, all, base, info);
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& h5_file, const std::vector<Grain>& all,
                                   StateReader& state) {
  try {
    UndoFile::take_back(h5_file);
  } catch (const std::system_error& error) {
    fail_to_write(h5_file, error.code().message());
  } catch (const std::runtime_error& error) {
    throw StateError(error.what());
  }
  ask_for_memory();
  const QuietHdf5 quiet;
  files_ = std::make_unique<Files>(h5_file, all, state);
}

void TrajectoryWriter::save(StateWriter& state) {
  if (!files_) throw std::runtime_error("trajectory: saved after close");
  ask_for_memory();
  const QuietHdf5 quiet;
  files_->save(state);
}

void TrajectoryWriter::forget_saved(const std::filesystem::path& h5_file) {
  UndoFile::forget(h5_file);
}

TrajectoryWriter::~TrajectoryWriter() {
  const QuietHdf5 quiet;
  files_.reset();
}

void TrajectoryWriter::write(const Snapshot& snapshot, std::int64_t step) {
  if (!files_) throw std::runtime_error("trajectory: written to after close");
  ask_for_memory();
  const QuietHdf5 quiet;
  files_->write_h5(snapshot, step);
  files_->times.push_back(snapshot.time);
  files_->write_xyz(snapshot, step);
  files_->write_xdmf();
}

void TrajectoryWriter::close() {
  if (!files_) return;
  ask_for_memory();
  const QuietHdf5 quiet;
  const std::unique_ptr<Files> files = std::move(files_);
  frames_ = static_cast<std::int64_t>(files->times.size());
  files->close();
}

std::int64_t TrajectoryWriter::frames() const {
  return files_ ? static_cast<std::int64_t>(files_->times.size()) : frames_;
}

}  // namespace scree
