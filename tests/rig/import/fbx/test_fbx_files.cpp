// FBX files that are damaged, of other versions, or of models that share a name.
#include "rig/error.h"
#include "rig/import/fbx/fbx.h"
#include "rig/import/fbx/tree.h"
#include "tests/rig/import/fbx/fbx_bytes.h"

#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

namespace {

const std::vector<FileNode> k_nodes = {{.name = "RootNode"}, {.name = "Joint", .parent = 0}};

std::string small_file(const FbxForm& form) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, {fbx_property("Lcl Translation", {0, 1, 0})});
  const FbxTestCurve curve = {{0, 1, 2}, {0, 60, 0}, {0x8 | 0x100, 0x8 | 0x100, 4}};
  file.move(file.layer(file.take("Take")), joint, "Lcl Rotation", {&curve, nullptr, &curve});
  return file.bytes(form);
}

std::string unread(std::string_view bytes) { return fbx_motion(bytes, k_nodes).unread; }

std::string with(std::string bytes, const std::string& what, const std::string& by) {
  const std::size_t at = bytes.find(what);
  EXPECT_NE(at, bytes.npos) << what;
  return at == bytes.npos ? bytes : bytes.replace(at, what.size(), by);
}

TEST(FbxFiles, OtherVersionsAndOtherFilesAreNotRead) {
  for (const FbxForm& form : k_fbx_forms) EXPECT_EQ(unread(small_file(form)), "") << form.version;
  EXPECT_EQ(unread(small_file({.is_text = true, .version = 6100})), "of version 6100");
  EXPECT_EQ(unread(small_file({.is_text = false, .version = 6100})), "of version 6100");
  EXPECT_EQ(unread(small_file({.is_text = false, .version = 8000})), "of version 8000");
  EXPECT_EQ(unread(""), "neither text nor binary FBX");
  EXPECT_EQ(unread("solid cube"), "neither text nor binary FBX");
  EXPECT_EQ(unread(std::string("FBXVersion: 7400\0", 17)), "neither text nor binary FBX");
  EXPECT_EQ(unread("FBXVersion: 7400\n"), "without objects");
  EXPECT_EQ(unread("FBXVersion: x\n"), "without a version");
  EXPECT_EQ(unread("\xEF\xBB\xBF" + small_file({})), "");
  std::string lines = small_file({});
  for (std::size_t at = 0; (at = lines.find('\n', at)) != lines.npos; at += 2) lines.replace(at, 1, "\r\n");
  EXPECT_EQ(unread(lines), "");
}

TEST(FbxFiles, HostileLengthsAndCounts) {
  const std::string text = small_file({});
  EXPECT_EQ(unread(with(text, "KeyTime: *3", "KeyTime: *1000000000")), "an array that is not as long as it says");
  EXPECT_EQ(unread(with(text, "KeyTime: *3", "KeyTime: *99999999999")), "an array without a length");
  EXPECT_EQ(unread(with(text, "KeyTime: *3", "KeyTime: *x")), "an array without a length");
  EXPECT_EQ(unread(with(text, "KeyTime: *3", "KeyTime: 3")), "a curve with another number of times than of values");
  EXPECT_EQ(unread(with(text, "KeyAttrRefCount", "KeyAttrRefC")), "a curve without KeyAttrRefCount");
  EXPECT_EQ(unread(with(text, "46186158000", "-46186158000")), "a curve with key times that fall");
  EXPECT_EQ(unread(with(text, "0,60,0", "0,nan,0")), "a curve with a key that is no number");
  EXPECT_EQ(unread(with(text, "0,60,0", "0,1e40,0")), "a curve with a key that is no number");
  EXPECT_EQ(unread(with(text, "0,60,0", "0,1e999,0")), "an array of what is no number");
  EXPECT_EQ(unread(with(text, "0,60,0", "0,1e-999,0")), "");
  std::string deep = text;
  for (int i = 0; i < 100'000; ++i) deep += "a: {\n";
  EXPECT_EQ(unread(deep), "elements too deep in each other");

  const std::string binary = small_file({.is_text = false, .version = 7400, .deflates = true});
  const std::size_t array = binary.find("KeyTime") + 7 + 1; // behind the type: count, encoding, bytes
  const auto patched = [&](std::size_t at, std::uint32_t word) {
    return std::string(binary).replace(at, 4, bytes_of(word));
  };
  EXPECT_EQ(unread(patched(array, 0xffffffffu)), "an array longer than its bytes can be");
  EXPECT_EQ(unread(patched(array, 1000)), "an array that cannot be inflated");
  EXPECT_EQ(unread(patched(array, 2)), "an array that cannot be inflated");
  EXPECT_EQ(unread(patched(array + 4, 7)), "an array of an unknown encoding");
  EXPECT_EQ(unread(patched(array + 8, 0xffffffffu)), "lengths beyond its end");
  const std::size_t objects = binary.find("Objects") - 13; // end, values, bytes of values, length of the name
  EXPECT_EQ(unread(patched(objects, 5)), "an element that ends beyond its place");
  EXPECT_EQ(unread(patched(objects, 0xffffffffu)), "an element that ends beyond its place");
  EXPECT_EQ(unread(patched(objects + 4, 0xffffffffu)), "more values than there is room for");
  const std::string wide = small_file({.is_text = false, .version = 7500});
  EXPECT_EQ(unread(std::string(wide).replace(wide.find("Objects") - 25, 8, std::string(8, '\xff'))),
            "an element that ends beyond its place");
}

TEST(FbxFiles, DamagedAnywhereTheyAreReadOrNot) {
  for (const FbxForm& form : k_fbx_forms) {
    const std::string whole = small_file(form);
    for (std::size_t size = 0; size < whole.size(); size += 5) unread(whole.substr(0, size));
    std::mt19937_64 random(3);
    int read = 0, refused = 0;
    for (int i = 0; i < 600; ++i) {
      std::string bytes = whole;
      for (int flips = 1 + i % 3; flips > 0; --flips) {
        char& byte = bytes[random() % bytes.size()];
        byte = static_cast<char>(byte ^ static_cast<char>(1 + random() % 255));
      }
      (unread(bytes).empty() ? read : refused) += 1;
      with_unique_names(bytes);
    }
    EXPECT_GT(read, 60) << form.version; // the flips do damage, but not only
    EXPECT_GT(refused, 60) << form.version;
  }
}

TEST(FbxFiles, ModelsOfOneNameAreNamedAndToldApart) {
  for (const FbxForm& form : k_fbx_forms) {
    FbxTestFile file;
    const std::int64_t hips = file.model("Hips", 0, {}), prop = file.model("Prop", 0, {}, "Mesh");
    file.model("Arm", prop, {}, "Mesh");
    file.model("Arm", hips, {});
    file.model("Ar0", hips, {});
    EXPECT_FALSE(with_unique_names(small_file(form)));
    std::string bytes = file.bytes(form);
    const auto message = [&]() -> std::string {
      try {
        check_fbx_names("test.fbx", bytes);
        return "";
      } catch (const InputError& error) {
        return error.what();
      }
    };
    EXPECT_EQ(message(), "test.fbx: model Arm: found two of this name (in Prop and in Hips), which the reader of FBX "
                         "cannot tell apart, expected names of their own: rename one");
    file.model("Arm", prop, {});
    bytes = file.bytes(form);
    EXPECT_THAT(message(), HasSubstr("test.fbx: joint Arm: found two of this name (in Hips and in Prop)"));
    const std::optional<FbxUniqueNames> unique = with_unique_names(bytes);
    ASSERT_TRUE(unique);
    EXPECT_THAT(unique->original, ElementsAre(Pair("Ar1", "Arm"), Pair("Ar2", "Arm")));
    EXPECT_EQ(unique->bytes.size(), bytes.size());
    EXPECT_FALSE(with_unique_names(unique->bytes));
    bytes = unique->bytes;
    EXPECT_EQ(message(), "");
  }
}

TEST(FbxFiles, TooManyTurnsAreNotRead) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, {});
  const FbxTestCurve curve = {{0, 1}, {0, 9e8f}, {4, 4}};
  file.move(file.layer(file.take("Take")), joint, "Lcl Rotation", {&curve, nullptr, nullptr});
  EXPECT_EQ(unread(file.bytes()), "with more turns than can be kept");
}

} // namespace
