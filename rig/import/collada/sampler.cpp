#include "rig/import/collada/sampler.h"

#include "rig/error.h"
#include "rig/import/collada/source.h"
#include "rig/math.h"

#include <cmath>

namespace tutu::rig::import_detail {
namespace {

using Law = ScalarKey::Law;

class Reader {
public:
  Reader(const ColladaDocument& document, const pugi::xml_node& sampler, std::size_t numbers, const std::string& place)
      : document_(document), sampler_(sampler), numbers_(numbers), place_(place) {}

  SamplerKeys keys() {
    const SourceArray times = input("INPUT");
    SourceArray values = input("OUTPUT");
    // Some leave out the stride, or count single numbers.
    if (values.stride < numbers_ && values.words.size() == times.count * numbers_)
      values = {std::move(values.words), times.count, numbers_, 0};
    if (times.count > 0 && (values.count < times.count || values.stride < numbers_))
      throw InputError(document_.file(), place_,
                       std::to_string(values.count) + " keys of " + std::to_string(values.stride) + " at " +
                           std::to_string(times.count) + " times",
                       "a key of " + std::to_string(numbers_) + " at each time");
    result_.curves.assign(numbers_, ScalarCurve(times.count));
    for (std::size_t k = 0; k < times.count; ++k) {
      const double time = number(times.word(k), "key time");
      if (k > 0 && time < result_.curves[0][k - 1].time)
        throw InputError(document_.file(), place_, "key times that fall", "rising key times");
      for (std::size_t i = 0; i < numbers_; ++i) {
        result_.curves[i][k].time = time;
        result_.curves[i][k].value = number(values.word(k, i), "key");
      }
    }
    read_laws(times.count);
    return std::move(result_);
  }

private:
  SourceArray input(std::string_view semantic) const {
    const pugi::xml_node found = input_of(sampler_, semantic);
    return found ? source_array(document_, document_.referred(found.attribute("source").value())) : SourceArray();
  }

  double number(std::string_view word, const char* what) const {
    const std::optional<double> value = number_of(word);
    if (!value || !(std::abs(*value) <= k_largest_number))
      throw InputError(document_.file(), place_, what + (" " + shown(word)), "finite numbers within +-1e9");
    return *value;
  }

  void read_laws(std::size_t count) {
    const SourceArray laws = input("INTERPOLATION"), leaving = input("OUT_TANGENT"), arriving = input("IN_TANGENT");
    for (std::size_t k = 0; k < count; ++k) {
      const std::string_view law = k < laws.count ? laws.word(k) : "LINEAR";
      const bool is_curved = law == "BEZIER" || law == "HERMITE";
      if (k + 1 < count && is_curved && has_handles(leaving, k) && has_handles(arriving, k + 1)) {
        for (std::size_t i = 0; i < numbers_; ++i) set_handles(k, i, law == "HERMITE", leaving, arriving);
        result_.is_straight = false;
        continue;
      }
      for (ScalarCurve& curve : result_.curves) curve[k].law = law == "STEP" ? Law::step : Law::linear;
      if (law != "STEP" && law != "LINEAR" && k + 1 < count && result_.doubt.empty())
        result_.doubt = (is_curved ? std::string(law) + " without tangents" : shown(law)) + " read as LINEAR";
    }
    for (ScalarCurve& curve : result_.curves) keep_handles_inside(curve);
  }

  /// A handle a number: its value alone, time and value, or one time for the values of all numbers.
  bool has_handles(const SourceArray& handles, std::size_t key) const {
    return key < handles.count &&
           (handles.stride == numbers_ || handles.stride == 2 * numbers_ || handles.stride == numbers_ + 1);
  }
  ScalarKey::Handle handle(const SourceArray& handles, std::size_t key, std::size_t i, double third) const {
    if (handles.stride == numbers_) return {third, number(handles.word(key, i), "tangent")};
    const bool is_pair = handles.stride == 2 * numbers_;
    return {number(handles.word(key, is_pair ? 2 * i : 0), "tangent"),
            number(handles.word(key, is_pair ? 2 * i + 1 : i + 1), "tangent")};
  }

  /// A Bezier's tangents are its control points; a Hermite's are derivatives by the parameter, three times as long as
  /// the way to the control point. One that is a value alone goes evenly in time.
  void set_handles(std::size_t k, std::size_t i, bool is_hermite, const SourceArray& leaving,
                   const SourceArray& arriving) {
    ScalarKey& key = result_.curves[i][k];
    const ScalarKey& next = result_.curves[i][k + 1];
    const double h = next.time - key.time;
    key.law = Law::bezier;
    if (!is_hermite) {
      key.leaving = handle(leaving, k, i, key.time + h / 3.0);
      key.arriving = handle(arriving, k + 1, i, next.time - h / 3.0);
      return;
    }
    const ScalarKey::Handle out = handle(leaving, k, i, h), in = handle(arriving, k + 1, i, h);
    key.leaving = {key.time + out.time / 3.0, key.value + out.value / 3.0};
    key.arriving = {next.time - in.time / 3.0, next.value - in.value / 3.0};
  }

  const ColladaDocument& document_;
  pugi::xml_node sampler_;
  std::size_t numbers_;
  const std::string& place_;
  SamplerKeys result_;
};

} // namespace

SamplerKeys read_sampler(const ColladaDocument& document, const pugi::xml_node& sampler, std::size_t numbers,
                         const std::string& place) {
  return Reader(document, sampler, numbers, place).keys();
}

} // namespace tutu::rig::import_detail
