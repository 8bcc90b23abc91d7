#include "proxies/proxy_file.h"

#include "rig/io/file_io.h"
#include "rig/io/json_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace tutu::proxies {
namespace {

constexpr int k_most_joints = std::tuple_size_v<decltype(Anchor::joints)>;
/// Weights whose sum is this near to 1 are kept to the bit: what was written is what is read.
constexpr double k_sum_tolerance = 1e-14;
/// Weights to write must sum to 1 this well; a worse sum is a mistake, not rounding.
constexpr double k_unit_sum = 1e-9;
/// How far apart (m) the joints of a skinned point may see it at rest and still mean one point.
constexpr double k_one_point = 1e-9;

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// "a joint of the skeleton, such as LeftLeg, LeftUpLeg, RightLeg": the three nearest to what was asked for.
std::string near_names(const rig::Skeleton& skeleton, const std::string& asked) {
  std::vector<std::pair<std::size_t, int>> near;
  const std::string bare = lower(rig::bare_joint_name(asked));
  for (int j = 0; j < skeleton.joint_count(); ++j)
    near.emplace_back(edit_distance(bare, lower(rig::bare_joint_name(skeleton.names[j]))), j);
  std::sort(near.begin(), near.end());
  near.resize(std::min<std::size_t>(near.size(), 3));
  std::string text = "a joint of the skeleton";
  for (std::size_t i = 0; i < near.size(); ++i) text += (i == 0 ? ", such as " : ", ") + skeleton.names[near[i].second];
  return text;
}

Anchor on_joint(int joint, const Vec3& point) {
  Anchor anchor;
  anchor.count = 1;
  anchor.joints[0] = joint;
  anchor.weights[0] = 1.0;
  anchor.points[0] = point;
  return anchor;
}

bool same(const Anchor& p, const Anchor& q) {
  if (p.count != q.count) return false;
  for (int k = 0; k < p.count; ++k)
    if (p.joints[k] != q.joints[k] || p.weights[k] != q.weights[k] || p.points[k] != q.points[k]) return false;
  return true;
}

// --- reading -------------------------------------------------------------------------------------------------------

class Reader {
public:
  explicit Reader(const rig::Skeleton& skeleton) : skeleton_(skeleton), rest_(rig::rest_model(skeleton)) {}

  Proxy proxy(const JsonValue& value, std::size_t place) const {
    value.only_keys({"name", "sphere", "capsule", "friction", "enabled"});
    const auto sphere = value.find("sphere"), capsule = value.find("capsule");
    if (sphere && capsule) throw value.error("both \"sphere\" and \"capsule\"", "one of them");
    if (!sphere && !capsule) throw value.error("neither \"sphere\" nor \"capsule\"", "one of them");
    Proxy proxy;
    if (sphere) read_sphere(*sphere, proxy);
    else read_capsule(*capsule, proxy);
    if (const auto friction = value.find("friction")) proxy.friction = friction->non_negative();
    if (const auto enabled = value.find("enabled")) proxy.enabled = enabled->boolean();
    proxy.name = skeleton_.names[proxy.a.joints[0]] + " " + std::to_string(place);
    if (const auto name = value.find("name")) {
      proxy.name = name->string();
      if (proxy.name.empty()) throw name->error("a name that is not empty");
    }
    return proxy;
  }

private:
  void read_sphere(const JsonValue& shape, Proxy& proxy) const {
    shape.only_keys({"joint", "center", "radius"});
    proxy.kind = ProxyKind::sphere;
    proxy.a = proxy.b = end(shape, shape.at("center"));
    check_joint_is_used(shape, {shape.at("center")});
    proxy.radius = shape.at("radius").positive();
  }

  void read_capsule(const JsonValue& shape, Proxy& proxy) const {
    shape.only_keys({"joint", "a", "b", "radius"});
    proxy.kind = ProxyKind::capsule;
    const JsonValue a = shape.at("a"), b = shape.at("b");
    proxy.a = end(shape, a);
    proxy.b = end(shape, b);
    check_joint_is_used(shape, {a, b});
    if (same(proxy.a, proxy.b)) throw shape.error("\"a\" and \"b\" at one point", "two points, or a \"sphere\"");
    const JsonValue radius = shape.at("radius");
    if (!radius.is_array()) {
      proxy.radius = radius.positive();
      return;
    }
    const std::vector<double> ends = radius.numbers(2);
    if (!(ends[0] > 0.0 && ends[1] > 0.0)) throw radius.error("a radius above 0, or two: [at a, at b]");
    proxy.radius = ends[0];
    proxy.taper = ends[1] - ends[0];
    // Beside a large radius a tiny one is rounded away.
    if (!(proxy.radius + proxy.taper > 0.0)) throw radius.error("two radii that can be told from 0 beside each other");
  }

  void check_joint_is_used(const JsonValue& shape, std::initializer_list<JsonValue> ends) const {
    const auto is_bare = [](const JsonValue& end) { return end.is_array(); };
    if (const auto name = shape.find("joint"); name && std::none_of(ends.begin(), ends.end(), is_bare)) {
      joint(*name);
      throw name->error("a joint that no point [x, y, z] here is on", "no \"joint\"");
    }
  }

  /// [x, y, z] on the shape's joint, or an object that names its own.
  Anchor end(const JsonValue& shape, const JsonValue& value) const {
    if (value.is_array()) return on_joint(joint(shape.at("joint")), value.vec3());
    if (!value.is_object()) throw value.error("[x, y, z] or an object with \"joint\", \"between\" or \"point\"");
    if (value.has("between")) return between(value);
    if (value.has("point")) return skinned(value);
    value.only_keys({"joint", "at", "between", "point", "joints"});
    return own_joint(value);
  }

  Anchor own_joint(const JsonValue& value) const {
    value.only_keys({"joint", "at"});
    return on_joint(joint(value.at("joint")), value.at("at").vec3());
  }

  Anchor between(const JsonValue& value) const {
    value.only_keys({"between", "at"});
    const JsonValue names = value.at("between");
    const std::vector<JsonValue> items = names.items();
    if (items.size() != 2) throw names.error("the names of two joints");
    const double at = value.at("at").number_in(0.0, 1.0);
    Anchor anchor;
    anchor.count = 2;
    for (int k = 0; k < 2; ++k) anchor.joints[k] = joint(items[k]);
    if (anchor.joints[0] == anchor.joints[1]) throw names.error("two different joints");
    anchor.weights[0] = 1.0 - at;
    anchor.weights[1] = at;
    return anchor;
  }

  Anchor skinned(const JsonValue& value) const {
    value.only_keys({"point", "joints"});
    const Vec3 point = value.at("point").vec3();
    const JsonValue list = value.at("joints");
    const std::vector<JsonValue> pairs = list.items();
    if (pairs.empty() || pairs.size() > k_most_joints)
      throw list.error(std::to_string(pairs.size()) + " joints", "1 to " + std::to_string(k_most_joints));
    Anchor anchor;
    for (const JsonValue& pair : pairs) {
      const std::vector<JsonValue> entry = pair.items();
      if (entry.size() != 2) throw pair.error("[joint name, weight]");
      const int index = joint(entry[0]);
      const auto used = anchor.joints.begin() + anchor.count;
      if (std::find(anchor.joints.begin(), used, index) != used) throw entry[0].error("each joint once");
      anchor.joints[anchor.count] = index;
      anchor.weights[anchor.count] = entry[1].positive();
      anchor.points[anchor.count] = rest_[index].inverse() * point;
      ++anchor.count;
    }
    normalise(anchor, list);
    return anchor;
  }

  static void normalise(Anchor& anchor, const JsonValue& list) {
    const double sum = std::accumulate(anchor.weights.begin(), anchor.weights.begin() + anchor.count, 0.0);
    if (!std::isfinite(sum)) throw list.error("weights whose sum is finite");
    if (std::abs(sum - 1.0) <= k_sum_tolerance) return;
    for (int k = 0; k < anchor.count; ++k) {
      anchor.weights[k] /= sum;
      if (!(anchor.weights[k] > 0.0)) throw list.error("weights that can be told from 0 beside each other");
    }
  }

  int joint(const JsonValue& name) const {
    const std::string text = name.string();
    if (const auto found = skeleton_.find(text)) return *found;
    throw name.error(near_names(skeleton_, text.substr(0, 100))); // how near is a product of lengths
  }

  const rig::Skeleton& skeleton_;
  std::vector<Transform> rest_; // model_from_joint
};

FitNote::Side fit_side(const JsonValue& value) {
  value.only_keys({"p95", "max", "bound"});
  return {value.at("p95").non_negative(), value.at("max").non_negative(), value.at("bound").non_negative()};
}

FitNote fit_note(const JsonValue& value) {
  value.only_keys({"character", "motion", "region", "poses", "under_mm", "over_mm"});
  FitNote note;
  note.character = value.at("character").string();
  note.motion = value.at("motion").string();
  note.region = value.at("region").string();
  note.poses = value.at("poses").integer_in(1, 1000000);
  note.under_mm = fit_side(value.at("under_mm"));
  note.over_mm = fit_side(value.at("over_mm"));
  return note;
}

// --- writing -------------------------------------------------------------------------------------------------------

using Json = nlohmann::ordered_json;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

[[noreturn]] void refuse(const Proxy& proxy, const std::string& why) {
  throw std::invalid_argument("write_proxies: proxy \"" + proxy.name + "\" " + why);
}

/// Both ends are on one joint as points of its frame.
bool on_one_joint(const Proxy& proxy) {
  return proxy.a.count == 1 &&
         (proxy.kind == ProxyKind::sphere || (proxy.b.count == 1 && proxy.a.joints[0] == proxy.b.joints[0]));
}

/// A blend of two joints' origins.
bool is_between(const Anchor& anchor) {
  return anchor.count == 2 && anchor.points[0].isZero(0.0) && anchor.points[1].isZero(0.0);
}

/// An end that names its own joints.
Json end_of(const Proxy& proxy, const Anchor& anchor, const rig::Skeleton& skeleton, std::span<const Transform> rest) {
  if (anchor.count == 1) return {{"joint", skeleton.names[anchor.joints[0]]}, {"at", numbers(anchor.points[0])}};
  if (is_between(anchor))
    return {{"between", {skeleton.names[anchor.joints[0]], skeleton.names[anchor.joints[1]]}},
            {"at", anchor.weights[1]}};
  const Vec3 point = rest[anchor.joints[0]] * anchor.points[0];
  Json joints = Json::array();
  for (int k = 0; k < anchor.count; ++k) {
    if ((rest[anchor.joints[k]] * anchor.points[k] - point).norm() > k_one_point)
      refuse(proxy, "has an end whose joints do not see one point at rest; a file cannot say that");
    joints.push_back({skeleton.names[anchor.joints[k]], anchor.weights[k]});
  }
  return {{"point", numbers(point)}, {"joints", joints}};
}

void require_writable(const Proxy& proxy, const Anchor& anchor, const rig::Skeleton& skeleton) {
  if (anchor.count < 1 || anchor.count > k_most_joints) refuse(proxy, "has an end on no joint, or on too many");
  double sum = 0.0;
  for (int k = 0; k < anchor.count; ++k) {
    const auto before = anchor.joints.begin() + k;
    if (anchor.joints[k] < 0 || anchor.joints[k] >= skeleton.joint_count())
      refuse(proxy, "is on a joint that does not exist");
    if (std::find(anchor.joints.begin(), before, anchor.joints[k]) != before) refuse(proxy, "has a joint twice");
    if (!is_finite(anchor.points[k])) refuse(proxy, "has a non-finite end");
    if (!(anchor.weights[k] > 0.0 || (anchor.weights[k] == 0.0 && is_between(anchor))))
      refuse(proxy, "has a weight that is not above 0");
    sum += anchor.weights[k];
  }
  if (!(std::abs(sum - 1.0) <= k_unit_sum)) refuse(proxy, "has weights that do not sum to 1");
}

void require_writable(const Proxy& proxy, const rig::Skeleton& skeleton) {
  const double at_b = proxy.radius + proxy.taper;
  if (!(std::isfinite(proxy.radius) && proxy.radius > 0.0 && std::isfinite(at_b) && at_b > 0.0))
    refuse(proxy, "has no radius above 0");
  if (proxy.kind == ProxyKind::sphere && proxy.taper != 0.0) refuse(proxy, "is a sphere with a taper");
  if (!(std::isfinite(proxy.friction) && proxy.friction >= 0.0)) refuse(proxy, "has a friction below 0");
  require_writable(proxy, proxy.a, skeleton);
  if (proxy.kind == ProxyKind::sphere) return;
  require_writable(proxy, proxy.b, skeleton);
  if (same(proxy.a, proxy.b)) refuse(proxy, "is a capsule with both ends at one point");
}

/// The shortest decimal whose difference from the first radius is the taper to the bit, where one is near: taper is a
/// difference of two such decimals, and the sum of both would show its rounding.
double second_radius(const Proxy& proxy) {
  const double sum = proxy.radius + proxy.taper;
  for (double scale = 1e3; scale <= 1e9; scale *= 10.0)
    if (const double decimal = std::round(sum * scale) / scale; decimal - proxy.radius == proxy.taper) return decimal;
  return sum;
}

Json shape_of(const Proxy& proxy, const rig::Skeleton& skeleton, std::span<const Transform> rest) {
  Json shape;
  const bool shared = on_one_joint(proxy);
  if (shared) shape["joint"] = skeleton.names[proxy.a.joints[0]];
  const auto end = [&](const Anchor& anchor) {
    return shared ? numbers(anchor.points[0]) : end_of(proxy, anchor, skeleton, rest);
  };
  if (proxy.kind == ProxyKind::sphere) {
    shape["center"] = end(proxy.a);
  } else {
    shape["a"] = end(proxy.a);
    shape["b"] = end(proxy.b);
  }
  if (proxy.taper == 0.0) shape["radius"] = proxy.radius;
  else shape["radius"] = {proxy.radius, second_radius(proxy)};
  return shape;
}

Json json_of(const FitNote& note) {
  const auto rounded = [](double mm) { return std::round(100.0 * mm) / 100.0; };
  const auto side = [&](const FitNote::Side& s) {
    return Json{{"p95", rounded(s.p95)}, {"max", rounded(s.max)}, {"bound", rounded(s.bound)}};
  };
  return {{"character", note.character}, {"motion", note.motion},           {"region", note.region},
          {"poses", note.poses},         {"under_mm", side(note.under_mm)}, {"over_mm", side(note.over_mm)}};
}

} // namespace

std::vector<Proxy> read_proxies(const std::filesystem::path& file, const rig::Skeleton& skeleton) {
  const JsonValue root = JsonValue::read(file);
  root.only_keys({"fit", "proxies"});
  if (const auto fit = root.find("fit")) fit_note(*fit);
  const Reader reader(skeleton);
  std::vector<Proxy> proxies;
  std::set<std::string> names;
  for (const JsonValue& item : root.at("proxies").items()) {
    proxies.push_back(reader.proxy(item, proxies.size()));
    if (!names.insert(proxies.back().name).second)
      throw item.error("the name \"" + proxies.back().name + "\" a second time", "every name once");
  }
  return proxies;
}

std::optional<FitNote> read_fit_note(const std::filesystem::path& file) {
  const auto fit = JsonValue::read(file).find("fit");
  return fit ? std::optional(fit_note(*fit)) : std::nullopt;
}

void write_proxies(const std::filesystem::path& file, const std::vector<Proxy>& proxies, const rig::Skeleton& skeleton,
                   const std::optional<FitNote>& fit) {
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  // One proxy a line: a list that a person reads and a version control compares.
  std::string text = "{ ";
  constexpr const char* k_schema = "../schema/proxies.schema.json";
  if (std::filesystem::exists(file.parent_path() / k_schema))
    text += std::string("\"$schema\": \"") + k_schema + "\",\n  ";
  if (fit) text += "\"fit\": " + json_of(*fit).dump() + ",\n  ";
  text += "\"proxies\": [";
  std::set<std::string> names;
  for (const Proxy& proxy : proxies) {
    require_writable(proxy, skeleton);
    if (proxy.name.empty() || !names.insert(proxy.name).second) refuse(proxy, "has no name of its own");
    Json value;
    value["name"] = proxy.name;
    value[proxy.kind == ProxyKind::sphere ? "sphere" : "capsule"] = shape_of(proxy, skeleton, rest);
    value["friction"] = proxy.friction;
    value["enabled"] = proxy.enabled;
    text += (names.size() == 1 ? "\n  " : ",\n  ") + value.dump();
  }
  write_file(file, text + "\n] }\n");
}

} // namespace tutu::proxies
