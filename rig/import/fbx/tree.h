// Private to the importer: an FBX file as a tree of elements, binary (7.0 to 7.7) or text [Blender Foundation 2013, FBX
// binary file format specification]. Nothing is copied: names, texts and arrays point into the bytes of the file, and
// arrays are unpacked when they are asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

/// A file that cannot be read soundly; says why, to stand behind "cannot be read: ".
class FbxUnreadable : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

struct FbxValue {
  enum class Kind : std::uint8_t { integer, real, text, array, text_array };
  Kind kind = Kind::integer;
  char element = 0;         ///< of a binary array: 'f', 'd', 'i', 'l' or 'b'
  bool is_deflated = false; ///< a binary array's bytes
  std::uint32_t count = 0;  ///< elements an array claims to have
  std::int64_t integer = 0;
  double real = 0.0;
  std::string_view text; ///< of an array what stands between its bounds, of a binary one its bytes
};

struct FbxElement {
  std::string_view name;
  std::vector<FbxValue> values;
  std::vector<FbxElement> children;

  const FbxElement* child(std::string_view wanted) const; ///< the first of this name, or null
};

struct FbxTree {
  int version = 0; ///< 7400, say
  bool is_text = false;
  std::vector<FbxElement> elements; ///< of the top: what motion is made of, no more (is_of_use)
};

/// The bytes must outlive the tree. Throws FbxUnreadable on what is neither form, on versions before 7.0 and from 8.0,
/// on lengths beyond the file, on elements nested more than 100 deep. Of what it does not keep it sees the place alone.
FbxTree parse_fbx(std::string_view bytes);

/// Of a whole number or a real one, else none.
std::optional<double> number_of(const FbxValue& value);
std::optional<std::int64_t> integer_of(const FbxValue& value);

/// The numbers of an element that holds an array, or (in old texts) one value a number. Throw FbxUnreadable where they
/// are not as many as claimed or of another kind.
std::vector<double> reals_of(const FbxElement& element);
std::vector<std::int64_t> integers_of(const FbxElement& element);
/// 32 bits a number, as a file keeps floats that are not all floats (in a text as whole numbers, from 7.2 on).
std::vector<std::uint32_t> words_of(const FbxElement& element, const FbxTree& tree);

} // namespace tutu::rig::import_detail
