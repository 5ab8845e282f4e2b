#include "sim/scene/yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unordered_map>

#include "sim/material/input_bytes.h"

namespace scree {
namespace {

/// Ends the parse from inside an event.
struct Refused {
  Place place;
  std::string message;
};

std::size_t count_nodes(const YamlNode& node) {
  std::size_t count = 1;
  for (const auto& item : node.items) count += count_nodes(item);
  for (const auto& entry : node.entries) count += count_nodes(entry.value);
  return count;
}

/// Builds the tree from the events of yaml-cpp, within the limits.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const Place& origin, std::vector<ScenarioError>& errors) : origin_(origin), errors_(errors) {}

  YamlNode root;
  bool has_root = false;

  Place place(const YAML::Mark& mark) const {
    if (origin_.line == 0) return origin_;
    return mark.is_null() ? Place{origin_.file, 1, 1} : Place{origin_.file, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_root) throw Refused{place(mark), "a second YAML document begins here; one document is expected"};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    count(mark, 1);
    finish(make(YamlKind::null, mark), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Refused{place(mark), "an alias stands inside the node it refers to"};
    count(mark, found->second.second);
    add(YamlNode(found->second.first));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    count(mark, 1);
    check_tag(mark, tag);
    YamlNode node = make(YamlKind::scalar, mark);
    node.text = value;
    node.quoted = tag == "!";
    finish(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlKind::sequence, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlKind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A map or a sequence that is still being filled.
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor = 0;
    std::optional<YamlNode> key;                ///< of the value that comes next
    std::unordered_map<std::string, int> seen;  ///< key -> line
  };

  YamlNode make(YamlKind kind, const YAML::Mark& mark) const {
    YamlNode node;
    node.kind = kind;
    node.place = place(mark);
    return node;
  }

  static bool plain_tag(const std::string& tag) { return tag.empty() || tag == "?" || tag == "!"; }

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!plain_tag(tag)) throw Refused{place(mark), "tag " + shown(tag) + ": YAML tags are not taken"};
  }

  void count(const YAML::Mark& mark, std::size_t more) {
    nodes_ += more;
    if (nodes_ > kMaxNodes)
      throw Refused{
          place(mark),
          fmt::format("more than {} values, aliases counted each time; no file of scree is like that",
                      kMaxNodes)};
  }

  void open(YamlKind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    count(mark, 1);
    check_tag(mark, tag);
    if (open_.size() >= kMaxDepth)
      throw Refused{place(mark),
                    fmt::format("nested deeper than {} levels; no file of scree is like that", kMaxDepth)};
    open_.push_back({make(kind, mark), anchor, {}, {}});
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  void finish(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = {node, count_nodes(node)};
    add(std::move(node));
  }

  void add(YamlNode node) {
    if (open_.empty()) {
      root = std::move(node);
      has_root = true;
      return;
    }
    Open& into = open_.back();
    if (into.node.kind == YamlKind::sequence) {
      into.node.items.push_back(std::move(node));
    } else if (!into.key) {
      if (node.kind != YamlKind::scalar) throw Refused{node.place, "a key must be a word"};
      into.key = std::move(node);
    } else {
      const auto [first, fresh] = into.seen.emplace(into.key->text, into.key->place.line);
      if (fresh) {
        into.node.entries.push_back({into.key->text, into.key->place, std::move(node)});
      } else {
        std::string where = first->second > 0 ? fmt::format(" in line {}", first->second) : std::string();
        report(errors_, into.key->place,
               fmt::format("duplicate key {}; it stands already{}, keep one", shown(into.key->text), where));
      }
      into.key.reset();
    }
  }

  Place origin_;
  std::vector<ScenarioError>& errors_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::pair<YamlNode, std::size_t>> anchors_;
  std::size_t nodes_ = 0;
};

}  // namespace

const YamlEntry* YamlNode::find(std::string_view key) const {
  for (const auto& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

void report(std::vector<ScenarioError>& errors, const Place& place, std::string message) {
  errors.push_back({*place.file, place.line, place.column, std::move(message)});
}

std::string shown(std::string_view text) {
  std::string out = "'";
  for (const char c : text.substr(0, 60)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  if (text.size() > 60) {
    while ((static_cast<unsigned char>(out.back()) & 0xC0) == 0x80)
      out.pop_back();  // no half of a UTF-8 letter
    if (static_cast<unsigned char>(out.back()) >= 0xC0) out.pop_back();
    out += "...";
  }
  return out + "'";
}

std::optional<YamlNode> parse_yaml(const std::string& text, const Place& origin,
                                   std::vector<ScenarioError>& errors) {
  TreeBuilder builder(origin, errors);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Refused& refused) {
    report(errors, refused.place, refused.message);
    return std::nullopt;
  } catch (const YAML::Exception& error) {
    report(errors, builder.place(error.mark), "not YAML: " + error.msg);
    return std::nullopt;
  }
  if (!builder.has_root) {
    builder.root.kind = YamlKind::map;
    builder.root.place = origin;
  }
  return std::move(builder.root);
}

std::optional<YamlNode> read_yaml(const std::filesystem::path& file, std::vector<ScenarioError>& errors) {
  const Place origin{std::make_shared<const std::string>(file.string()), 1, 1};
  const Place whole{origin.file, 0, 0};
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) {
    report(errors, whole, "no such file");
    return std::nullopt;
  }
  if (!std::filesystem::is_regular_file(status)) {
    report(errors, whole, "not a file; give a YAML file");
    return std::nullopt;
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(kMaxFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.is_open() || stream.bad()) {
    report(errors, whole, "cannot be read");
    return std::nullopt;
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxFileBytes) {
    report(errors, whole, "larger than 1 MB; no file of scree is like that");
    return std::nullopt;
  }
  try {
    require_text(file, text);
  } catch (const FileError& error) {
    report(errors, whole, error.message);
    return std::nullopt;
  }
  if (const int line = line_that_is_not_utf8(text)) {
    report(errors, {origin.file, line, 1}, "is not UTF-8; save the file as UTF-8");
    return std::nullopt;
  }
  auto root = parse_yaml(text, origin, errors);
  if (root && root->kind == YamlKind::null) {  // a document without content
    root->kind = YamlKind::map;
  } else if (root && root->kind != YamlKind::map) {
    report(errors, root->place, "a map of keys (`key: value`) is expected");
    return std::nullopt;
  }
  return root;
}

void merge_yaml(YamlNode& base, YamlNode over) {
  if (base.kind != YamlKind::map || over.kind != YamlKind::map) {
    base = std::move(over);
    return;
  }
  // What is missing in a map is told at the later file, but never at an override: it is not the override's
  // fault.
  if (over.place.line > 0) base.place = over.place;
  for (auto& entry : over.entries) {
    YamlEntry* same = nullptr;
    for (auto& known : base.entries)
      if (known.key == entry.key) same = &known;
    if (same == nullptr) {
      base.entries.push_back(std::move(entry));
    } else {
      same->key_place = entry.key_place;
      merge_yaml(same->value, std::move(entry.value));
    }
  }
}

std::string yaml_text(const std::string& text) {
  const bool plain = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
                     std::all_of(text.begin(), text.end(), [](unsigned char c) {
                       return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.' || c == '-';
                     });
  static const std::vector<std::string> words = {"true", "false", "null", "yes", "no", "on",
                                                 "off",  "y",     "n",    "inf", "nan"};
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (plain && std::find(words.begin(), words.end(), lower) == words.end()) return text;
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace scree
