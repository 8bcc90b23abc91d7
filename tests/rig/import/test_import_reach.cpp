// What a model names outside of its folder is not opened; what it cannot do without is refused by name.
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/import/surface.h"
#include "rig/io/file_io.h"
#include "tests/rig/import/other_process.h"
#include "tests/rig/import/tiny_collada.h"
#include "tests/rig/import/tiny_glb.h"

#include <cstring>
#include <gmock/gmock.h>
#include <sys/stat.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

namespace {

/// The parts of a .glb [glTF 2.0, 4.4].
std::string json_of(const std::string& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  return glb.substr(20, length);
}
std::string binary_of(const std::string& glb) { return glb.substr(20 + json_of(glb).size() + 8); }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return at == text.npos ? text : text.replace(at, what.size(), by);
}

/// A folder with a model's place in it, and secrets beside: good geometry, so that what is read shows.
struct Place {
  fs::path folder = scratch_folder(), inside = folder / "model", secret = folder / "secret.bin";
  fs::path model = inside / "tiny.gltf";

  Place() {
    fs::create_directories(inside / "below");
    for (const fs::path& file : {secret, inside / "buffer.bin", inside / "below/buffer.bin"})
      write_file(file, binary_of(tiny_glb()));
    fs::create_symlink("../secret.bin", inside / "link.bin");
    fs::create_directory_symlink("..", inside / "up");
    ::mkfifo((folder / "pipe.bin").c_str(), 0600); // whoever opens it hangs
  }

  /// Of the model with this text for its buffer's "uri": …; "" when it was read.
  std::string message(const std::string& uri) const {
    write_file(model, replaced(json_of(tiny_glb()), R"("byteLength":276})", R"("byteLength":276,)" + uri + "}"));
    return message_of(model);
  }
  static std::string message_of(const fs::path& file) {
    try {
      import_character(file);
      return "";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string()));
      return error.what();
    }
  }
};

TEST(ImportReach, BuffersBesideAndBelowAreRead) {
  const Place place;
  EXPECT_EQ(place.message(R"("uri":"buffer.bin")"), "");
  EXPECT_EQ(place.message(R"("uri":"below/buffer.bin")"), "");
  EXPECT_EQ(place.message(R"("uri":"below/../buffer.bin")"), "");
  EXPECT_EQ(place.message(R"("uri":"./buffer.bin")"), "");
  fs::create_symlink("below/buffer.bin", place.inside / "within.bin");
  EXPECT_EQ(place.message(R"("uri":"within.bin")"), "");
}

TEST(ImportReach, BuffersOutsideAreRefusedByName) {
  const Place place;
  Watch watch(place.secret);
  const std::string absolute = place.secret.string();
  for (const std::string& name :
       {std::string("../secret.bin"), std::string("below/../../secret.bin"), std::string("link.bin"),
        std::string("up/secret.bin"), std::string("../none.bin"), std::string("../pipe.bin"), absolute,
        (place.inside / "buffer.bin").string(), "file://" + absolute, std::string("FILE:secret.bin"),
        std::string("http://localhost/secret.bin"), std::string("..\\\\secret.bin"), std::string("C:\\\\secret.bin"),
        std::string("/proc/self/environ"), std::string("../model/../secret.bin")}) {
    const std::string message = place.message("\"uri\":\"" + name + '"');
    EXPECT_THAT(message, HasSubstr("outside of its folder, expected a file in the model's folder or below")) << name;
    EXPECT_THAT(message, HasSubstr("/buffers/0/uri: found " + name.substr(0, 3)));
  }
  EXPECT_EQ(place.message(R"("uri":"../secret.bin")"),
            place.model.string() + ": /buffers/0/uri: found ../secret.bin, outside of its folder, expected a file in "
                                   "the model's folder or below");
  EXPECT_FALSE(watch.saw_it_opened());
}

TEST(ImportReach, NoWayOfWritingANameLeadsOut) {
  const Place place;
  Watch watch(place.secret);
  for (const char* uri : {
           R"("uri":"%2e%2e/secret.bin")",
           R"("uri":"..%2fsecret.bin")",
           R"("uri":"\u002e\u002e/secret.bin")",
           R"("uri":"../secret.bin","uri":"buffer.bin")", // two parsers may choose differently
           R"("uri":"buffer.bin","uri":"../secret.bin")",
           R"("uri":"../secret.bin\u0000.png")",
           R"("uri":" ../secret.bin")",
           R"("uri":".//..//secret.bin")",
           R"("uri":["../secret.bin"])",
       })
    EXPECT_THAT(place.message(uri),
                AnyOf(HasSubstr("outside of its folder"), HasSubstr("found it twice"),
                      HasSubstr("a name with a zero in it"), HasSubstr("no such file"), HasSubstr("expected a string")))
        << uri;
  EXPECT_FALSE(watch.saw_it_opened());
  fs::remove(place.inside / "buffer.bin");
  fs::create_symlink("../secret.bin", place.inside / "buffer.bin");
  EXPECT_THAT(place.message(R"("uri":"buffer.bin")"), HasSubstr("outside of its folder"));
  EXPECT_FALSE(watch.saw_it_opened());
}

TEST(ImportReach, AModelMayItselfBeALink) {
  const Place place;
  write_file(place.folder / "tiny.glb", tiny_glb());
  fs::create_symlink("../tiny.glb", place.inside / "tiny.glb");
  EXPECT_EQ(Place::message_of(place.inside / "tiny.glb"), "");
}

TEST(ImportReach, TexturesOutsideAreNotOpenedButNoted) {
  const Place place;
  Watch watch(place.secret);
  std::string text = replaced(json_of(tiny_glb()), R"("byteLength":276})", R"("byteLength":276,"uri":"buffer.bin"})");
  text = replaced(text, R"("indices":6)", R"("indices":6,"material":0)");
  text = replaced(text, R"("skins":)", R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
"normalTexture":{"index":1},"emissiveTexture":{"index":2}}],"textures":[{"source":0},{"source":1},{"source":2}],
"images":[{"uri":"../secret.bin"},{"uri":"skin.png"},{"uri":"/etc/passwd"}],"skins":)");
  write_file(place.model, text);
  EXPECT_THAT(import_character(place.model).report.notes,
              Contains("2 textures outside of the file's folder not opened: ../secret.bin, /etc/passwd"));
  EXPECT_FALSE(watch.saw_it_opened());
}

TEST(ImportReach, ColladaInOneDocument) {
  const Place place;
  const fs::path model = place.inside / "tiny.dae", other = place.folder / "other.dae";
  const std::string text = collada_text(upright());
  write_file(other, text);
  write_file(place.inside / "other.dae", text);
  Watch watch(other), beside(place.inside / "other.dae");
  const auto message = [&](const std::string& what, const std::string& by) {
    write_file(model, replaced(text, what, by));
    return Place::message_of(model);
  };
  EXPECT_EQ(message("<skin source=\"#body\"", "<skin source=\"../other.dae#body\""),
            model.string() + ": skin: found ../other.dae#body, outside of its folder, expected a file in the model's "
                             "folder or below");
  EXPECT_THAT(message("<skin source=\"#body\"", "<skin source=\"file:///tmp/other.dae#body\""),
              HasSubstr("found file:///tmp/other.dae#body, outside of its folder"));
  EXPECT_THAT(message("<instance_controller url=\"#", "<instance_controller url=\"other.dae#"),
              HasSubstr("instance_controller: found other.dae#body-skin, in another document, expected all of the "
                        "character in one file"));
  EXPECT_THAT(message("<instance_visual_scene url=\"#", "<instance_visual_scene url='/tmp/other.dae#"),
              AnyOf(HasSubstr("outside of its folder"), HasSubstr("cannot be read")));
  EXPECT_FALSE(watch.saw_it_opened());
  EXPECT_FALSE(beside.saw_it_opened());
}

TEST(ImportReach, MaterialsOfAnObjAreNeverOpened) {
  const Place place;
  const fs::path model = place.inside / "a.obj";
  write_file(place.inside / "a.mtl", "x\n");
  write_file(place.inside / "b.mtl", "newmtl m\nmap_Kd ../secret.bin\n");
  Watch own(place.inside / "a.mtl"), other(place.inside / "b.mtl"), watch(place.secret);
  for (const std::string& name : {std::string("a.mtl"), std::string("b.mtl"), std::string("../secret.bin"),
                                  place.secret.string(), std::string("../pipe.bin"), std::string("none.mtl")}) {
    write_file(model, "mtllib " + name + "\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(import_surface(model).positions.size(), 3u) << name;
  }
  EXPECT_FALSE(own.saw_it_opened());
  EXPECT_FALSE(other.saw_it_opened());
  EXPECT_FALSE(watch.saw_it_opened());
}

TEST(ImportReach, ASurfacesBuffersToo) {
  const Place place;
  Watch watch(place.secret);
  EXPECT_EQ(place.message(R"("uri":"buffer.bin")"), "");
  EXPECT_EQ(import_surface(place.model).triangles.size(), 1u);
  place.message(R"("uri":"link.bin")");
  try {
    import_surface(place.model);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/buffers/0/uri: found link.bin, outside of its folder"));
  }
  EXPECT_FALSE(watch.saw_it_opened());
}

} // namespace
