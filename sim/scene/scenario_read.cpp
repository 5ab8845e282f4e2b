#include "sim/scene/scenario_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <type_traits>

#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

class Reader {
 public:
  Reader(const fs::path& asset_dir, bool incomplete, ReadNotes& notes)
      : asset_dir_(asset_dir), incomplete_(incomplete), notes_(notes) {}

  /// Reads the keys of one map; `also` are allowed keys that are read elsewhere.
  void group(const YamlNode& map, const Fields& fields, const std::string& prefix,
             const std::vector<std::string>& also = {}) {
    std::vector<std::string> allowed = also;
    for (const Field& field : fields) allowed.emplace_back(field.name);
    for (const YamlEntry& entry : map.entries) {
      if (std::find(allowed.begin(), allowed.end(), entry.key) != allowed.end()) continue;
      const std::string in = prefix.empty() ? "" : " in " + prefix.substr(0, prefix.size() - 1);
      report(notes_.errors, entry.key_place,
             fmt::format("unknown key {}{}{}; allowed: {}", shown(entry.key), in,
                         suggestion(entry.key, allowed), join(allowed)));
    }
    for (const Field& field : fields) {
      const std::string path = prefix + std::string(field.name);
      const YamlEntry* entry = map.find(field.name);
      std::visit([&](const auto& target) { key(target, field, entry, map.place, path); }, field.target);
    }
  }

 private:
  void fail(const Place& place, const void* value, const std::string& path, const std::string& message) {
    report(notes_.errors, place, path.empty() ? message : path + ": " + message);
    if (value != nullptr) notes_.bad.insert(value);
  }

  /// A key whose value is not a map: read it when it is there.
  template <class Leaf>
  void key(const Leaf& target, const Field& field, const YamlEntry* entry, const Place& around,
           const std::string& path) {
    const void* address = address_of(target);
    notes_.places[address] = entry != nullptr ? entry->value.place : around;
    if (entry != nullptr) {
      if (entry->value.kind == YamlKind::null)
        fail(entry->key_place, address, path, "empty; write a value or leave the key out");
      else
        read(target, entry->value, path);
    } else if (field.required) {
      missing(address, around, path, field.doc);
    } else if constexpr (std::is_same_v<Leaf, MeshFile>) {
      mesh(target, std::string(target.standard), around, path);
    }
  }

  void key(const Extends&, const Field&, const YamlEntry*, const Place&, const std::string&) {}

  void key(const Group& target, const Field&, const YamlEntry* entry, const Place& around,
           const std::string& path) {
    group(as_map(entry, around, path), target.fields(), path + ".");
  }

  void key(const GroupList& target, const Field& field, const YamlEntry* entry, const Place& around,
           const std::string& path) {
    if (entry == nullptr) {
      if (field.required) missing(nullptr, around, path, field.doc);
      return;
    }
    const YamlNode& list = entry->value;
    if (!is_list(list, target.count, nullptr, path)) return;
    target.resize(list.items.size());
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const std::string item = fmt::format("{}[{}]", path, i);
      if (list.items[i].kind != YamlKind::map)
        fail(list.items[i].place, nullptr, item, "a map of keys is expected, found " + found(list.items[i]));
      else
        group(list.items[i], target.fields(i), item + ".");
    }
  }

  void key(const Optionals& target, const Field&, const YamlEntry* entry, const Place& around,
           const std::string& path) {
    if (entry == nullptr) return;
    const YamlNode map = as_map(entry, around, path);
    const std::vector<std::string> allowed(target.names.begin(), target.names.end());
    std::vector<bool> there(allowed.size());
    for (const YamlEntry& group : map.entries) {
      const auto at = std::find(allowed.begin(), allowed.end(), group.key);
      if (at != allowed.end())
        there[static_cast<std::size_t>(at - allowed.begin())] = true;
      else
        report(notes_.errors, group.key_place,
               fmt::format("unknown key {} in {}{}; allowed: {}", shown(group.key), path,
                           suggestion(group.key, allowed), join(allowed)));
    }
    target.select(there);
    for (std::size_t k = 0; k < allowed.size(); ++k) {
      if (!there[k]) continue;
      const std::string inner = path + "." + allowed[k];
      group(as_map(map.find(allowed[k]), map.place, inner), target.fields(k), inner + ".");
    }
  }

  void key(const OneOf& target, const Field&, const YamlEntry* entry, const Place& around,
           const std::string& path) {
    const YamlNode map = as_map(entry, around, path);
    const YamlEntry* type = map.find("type");
    if (type == nullptr) {
      missing(nullptr, map.place, path + ".type", target.doc);
      return;
    }
    const int index = choose(type->value, target.names, nullptr, path + ".type");
    if (index < 0) return;
    for (const YamlEntry& other : map.entries) other_type(target, index, other, path);
    target.select(index);
    // Keys of another type have their message already; the table would call them unknown.
    YamlNode known = map;
    std::erase_if(known.entries, [&](const YamlEntry& e) { return !types_of(target, index, e.key).empty(); });
    group(known, target.fields(), path + ".", {"type"});
  }

  /// The other types that have this key, when the chosen one has not.
  static std::vector<std::string> types_of(const OneOf& target, int chosen, std::string_view name) {
    const auto has = [&](int index) {
      target.select(index);
      const Fields fields = target.fields();
      return std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    };
    std::vector<std::string> others;
    if (!has(chosen))
      for (int i = 0; i < static_cast<int>(target.names.size()); ++i)
        if (i != chosen && has(i)) others.emplace_back(target.names[static_cast<std::size_t>(i)]);
    target.select(chosen);
    return others;
  }

  void other_type(const OneOf& target, int chosen, const YamlEntry& entry, const std::string& path) {
    const std::vector<std::string> others = types_of(target, chosen, entry.key);
    if (others.empty()) return;
    report(notes_.errors, entry.key_place,
           fmt::format("key '{}' in {} belongs to type {}, but the type here is {}", entry.key, path,
                       fmt::join(others, " or "), target.names[static_cast<std::size_t>(chosen)]));
  }

  void missing(const void* address, const Place& place, const std::string& path, std::string_view doc) {
    if (address != nullptr) notes_.bad.insert(address);
    const auto around = [&](const std::string& map) { return path.starts_with(map); };
    if (!incomplete_ && std::none_of(no_maps_.begin(), no_maps_.end(), around))
      report(notes_.errors, place, fmt::format("'{}' is missing: {}", path, doc.substr(0, doc.size() - 1)));
  }

  /// The map at a key; an empty one when there is none.
  YamlNode as_map(const YamlEntry* entry, const Place& around, const std::string& path) {
    if (entry != nullptr && entry->value.kind == YamlKind::map) return entry->value;
    YamlNode empty;
    empty.kind = YamlKind::map;
    empty.place = around;
    if (entry == nullptr) return empty;
    empty.place = entry->value.place;
    no_maps_.push_back(path + ".");
    if (entry->value.kind == YamlKind::null)
      fail(entry->key_place, nullptr, path, "empty; write its keys or leave it out");
    else
      fail(empty.place, nullptr, path, "a map of keys is expected, found " + found(entry->value));
    return empty;
  }

  bool is_list(const YamlNode& node, Count count, const void* address, const std::string& path) {
    if (node.kind != YamlKind::sequence) {
      fail(node.place, address, path, fmt::format("a list is expected, found {}", found(node)));
      return false;
    }
    if (node.items.size() < count.least || node.items.size() > count.most) {
      fail(node.place, address, path,
           fmt::format("{} entries; allowed {}{}", node.items.size(), count.least,
                       count.least == count.most ? "" : fmt::format(" to {}", count.most)));
      return false;
    }
    return true;
  }

  std::optional<double> number(const YamlNode& node, std::string_view unit, const Range& range,
                               const void* address, const std::string& path) {
    const std::string expected = unit.empty() ? "a number" : fmt::format("a number in {}", unit);
    double value = 0;
    const Parsed parsed =
        node.kind == YamlKind::scalar && !node.quoted ? parse_number(node.text, value) : Parsed::no;
    if (parsed == Parsed::not_finite) {
      fail(node.place, address, path,
           fmt::format("{} is not finite; allowed {}", node.text.substr(0, 40), range_text(range, unit)));
    } else if (parsed == Parsed::no) {
      fail(node.place, address, path,
           expected + " is expected, found " + found(node) + unit_hint(node, unit));
    } else if (!range.holds(value)) {
      fail(node.place, address, path,
           fmt::format("{} is out of range; allowed {}", value, range_text(range, unit)));
    } else {
      return value;
    }
    return std::nullopt;
  }

  /// "10 ft": a number and a word.
  static std::string unit_hint(const YamlNode& node, std::string_view unit) {
    if (node.kind != YamlKind::scalar) return "";
    double ignored = 0;
    const auto letters = node.text.find_last_of("0123456789.");
    if (letters == std::string::npos || letters + 1 == node.text.size() ||
        parse_number(std::string_view(node.text).substr(0, letters + 1), ignored) != Parsed::yes)
      return "";
    return unit.empty() ? "; write the number alone"
                        : fmt::format("; write the number alone, its unit is {}", unit);
  }

  template <class Int>
  std::optional<Int> integer(const YamlNode& node, const Range& range, const void* address,
                             const std::string& path) {
    double as_number = 0;
    const bool scalar = node.kind == YamlKind::scalar && !node.quoted;
    const Parsed parsed = scalar ? parse_number(node.text, as_number) : Parsed::no;
    if (parsed == Parsed::no ||
        (parsed == Parsed::yes && node.text.find_first_of(".eE") != std::string::npos)) {
      fail(node.place, address, path, "a whole number is expected, found " + found(node));
      return std::nullopt;
    }
    Int value = 0;
    const char* end = node.text.data() + node.text.size();
    const auto [stop, failure] =
        std::from_chars(node.text.data() + (node.text[0] == '+' ? 1 : 0), end, value);
    const bool fits = failure == std::errc() && stop == end &&
                      (std::is_same_v<Int, std::uint64_t> ? value <= static_cast<Int>(kLargestSeed)
                                                          : range.holds(static_cast<double>(value)));
    if (!fits) {
      const std::string limits =
          std::is_same_v<Int, std::uint64_t> ? fmt::format("0 to {}", kLargestSeed) : range_text(range, "");
      fail(node.place, address, path,
           fmt::format("{} is out of range; allowed {}", node.text.substr(0, 40), limits));
      return std::nullopt;
    }
    return value;
  }

  std::optional<std::string> text(const YamlNode& node, const void* address, const std::string& path) {
    if (is_plain_text(node)) return node.text;
    const bool scalar = node.kind == YamlKind::scalar;
    fail(node.place, address, path,
         "text is expected, found " + found(node) + (scalar ? "; put it in quotes" : ""));
    return std::nullopt;
  }

  int choose(const YamlNode& node, const std::vector<std::string_view>& names, const void* address,
             const std::string& path) {
    if (node.kind == YamlKind::scalar) {
      const auto at = std::find(names.begin(), names.end(), node.text);
      if (at != names.end()) return static_cast<int>(at - names.begin());
    }
    const std::vector<std::string> allowed(names.begin(), names.end());
    if (node.kind == YamlKind::scalar)
      fail(node.place, address, path,
           fmt::format("{} is not known{}; allowed: {}", found(node), suggestion(node.text, allowed),
                       join(allowed)));
    else
      fail(node.place, address, path,
           fmt::format("a word is expected, found {}; allowed: {}", found(node), join(allowed)));
    return -1;
  }

  void read(const Number& t, const YamlNode& node, const std::string& path) {
    if (const auto value = number(node, t.unit, t.range, t.value, path)) *t.value = *value * t.factor;
  }
  void read(const NumberOr& t, const YamlNode& node, const std::string& path) {
    if (node.kind == YamlKind::scalar && node.text == t.word)
      t.value->reset();
    else if (const auto value = number(node, "", t.range, t.value, path))
      *t.value = *value;
  }
  void read(const Integer& t, const YamlNode& node, const std::string& path) {
    if (const auto value = integer<int>(node, t.range, t.value, path)) *t.value = *value;
  }
  void read(const Boolean& t, const YamlNode& node, const std::string& path) {
    const bool plain = node.kind == YamlKind::scalar && !node.quoted;
    if (plain && (node.text == "true" || node.text == "false"))
      *t.value = node.text == "true";
    else
      fail(node.place, t.value, path, "true or false is expected, found " + found(node));
  }
  void read(const Text& t, const YamlNode& node, const std::string& path) {
    const auto value = text(node, t.value, path);
    if (!value) return;
    if (value->size() < t.length.least || value->size() > t.length.most)
      fail(node.place, t.value, path,
           fmt::format("{} letters; allowed {} to {}", value->size(), t.length.least, t.length.most));
    else
      *t.value = *value;
  }
  void read(const Choice& t, const YamlNode& node, const std::string& path) {
    const int index = choose(node, t.names, nullptr, path);
    if (index >= 0) t.set(index);
  }
  void read(const Vector& t, const YamlNode& node, const std::string& path) {
    if (!is_list(node, {3, 3}, t.value, path)) return;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto value = number(node.items[at], t.unit, t.range, t.value, fmt::format("{}[{}]", path, i));
      if (value) (*t.value)[i] = *value;
    }
  }

  /// Reads a list entry by entry; `one` gives the value of an entry or nothing.
  template <class T, class One>
  void list(std::vector<T>& into, Count count, const YamlNode& node, const std::string& path, One one) {
    if (!is_list(node, count, &into, path)) return;
    std::vector<T> values;
    std::vector<Place> places;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      if (std::optional<T> value = one(node.items[i], fmt::format("{}[{}]", path, i))) {
        values.push_back(std::move(*value));
        places.push_back(node.items[i].place);
      }
    }
    into = std::move(values);
    for (std::size_t i = 0; i < into.size(); ++i) notes_.places[&into[i]] = places[i];
  }

  void read(const Numbers& t, const YamlNode& node, const std::string& path) {
    list(*t.value, t.count, node, path, [&](const YamlNode& item, const std::string& at) {
      return number(item, t.unit, t.range, t.value, at);
    });
  }
  void read(const Integers& t, const YamlNode& node, const std::string& path) {
    list(*t.value, t.count, node, path, [&](const YamlNode& item, const std::string& at) {
      return integer<int>(item, t.range, t.value, at);
    });
  }
  void read(const Texts& t, const YamlNode& node, const std::string& path) {
    list(*t.value, t.count, node, path,
         [&](const YamlNode& item, const std::string& at) { return text(item, t.value, at); });
  }
  void read(const Seeds& t, const YamlNode& node, const std::string& path) {
    std::set<std::uint64_t> seen;
    list(*t.value, t.count, node, path,
         [&](const YamlNode& item, const std::string& at) -> std::optional<std::uint64_t> {
           const auto seed = integer<std::uint64_t>(item, {}, t.value, at);
           if (seed && !seen.insert(*seed).second) {
             fail(item.place, t.value, at, fmt::format("seed {} is given twice; seeds are distinct", *seed));
             return std::nullopt;
           }
           return seed;
         });
  }

  void read(const MeshFile& t, const YamlNode& node, const std::string& path) {
    if (const auto name = text(node, t.value, path)) mesh(t, *name, node.place, path);
  }

  void mesh(const MeshFile& t, const std::string& name, const Place& place, const std::string& path) {
    notes_.places[t.value] = place;
    if (const auto file = first_file({folder(place) / name, asset_dir_ / name})) {
      *t.value = *file;
      notes_.meshes.push_back({t.value, t.scale, path, place});
    } else {
      fail(
          place, t.value, path,
          fmt::format("no mesh {}, neither beside the scenario nor in {}", shown(name), asset_dir_.string()));
    }
  }

  void read(const GradingFile& t, const YamlNode& node, const std::string& path) {
    const auto name = text(node, t.value, path);
    if (!name) return;
    const fs::path gradings = asset_dir_ / "gradings";
    const bool is_path = name->find('/') != std::string::npos || name->ends_with(".csv");
    const auto file = is_path ? first_file({folder(node.place) / *name, asset_dir_ / *name, gradings / *name})
                              : first_file({gradings / (*name + ".csv")});
    if (file) {
      *t.value = *file;
      return;
    }
    std::vector<std::string> known;
    std::error_code none;
    for (const auto& item : fs::directory_iterator(gradings, none))
      if (item.path().extension() == ".csv") known.push_back(item.path().stem().string());
    std::sort(known.begin(), known.end());
    fail(node.place, t.value, path,
         fmt::format("no grading {}{}; known: {}; or give the path of a CSV file", shown(*name),
                     suggestion(*name, known), join(known)));
  }

  /// Folder that relative paths of a value start from: its file's, or the current one for an override.
  static fs::path folder(const Place& place) {
    return place.line == 0 ? fs::path() : fs::path(*place.file).parent_path();
  }

  static std::optional<fs::path> first_file(std::initializer_list<fs::path> candidates) {
    std::error_code none;
    for (const fs::path& path : candidates)
      if (fs::is_regular_file(path, none)) return clean_path(path);
    return std::nullopt;
  }

  template <class Leaf>
  static const void* address_of(const Leaf& target) {
    if constexpr (std::is_same_v<Leaf, Choice>)
      return nullptr;  // a choice is always valid on its own
    else
      return target.value;
  }

  const fs::path& asset_dir_;
  bool incomplete_;
  std::vector<std::string> no_maps_;  // paths, with a point, of groups that are something else
  ReadNotes& notes_;
};

}  // namespace

void read_keys(const YamlNode& root, Scenario& scenario, const fs::path& asset_dir, bool incomplete,
               ReadNotes& notes) {
  Reader(asset_dir, incomplete, notes).group(root, scenario_keys(scenario), "");
}

}  // namespace scree
