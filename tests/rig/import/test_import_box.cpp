// What a reader may do that was led astray: each thing it might try is tried from inside the box.
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/refused_calls.h"
#include "tests/rig/import/other_process.h"
#include "tests/rig/import/tiny_collada.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/landlock.h>
#include <map>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <thread>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

constexpr Bounds k_bounds = {std::uintmax_t{1} << 30, 5};
constexpr int k_pipe = 3; ///< what the box leaves a reader to answer into

struct Attempt {
  const char* name;
  std::function<long()> call; ///< -1 and errno when it fails
};

/// errno of each attempt inside the box around `file`; 0 where it was allowed.
std::map<std::string, int> errors_in_box(const std::string& file, const std::vector<Attempt>& attempts) {
  const std::string answer = isolated_answer(file, k_bounds, "an answer", [&](Packer& packer) {
    for (const Attempt& attempt : attempts) {
      errno = 0;
      int error = attempt.call() == -1 ? errno : 0;
      pass(packer, error);
    }
  });
  EXPECT_EQ(answer.size(), 1 + attempts.size() * sizeof(int)) << answer;
  Unpacker unpacker(std::string_view(answer).substr(1));
  std::map<std::string, int> errors;
  for (const Attempt& attempt : attempts) pass(unpacker, errors[attempt.name]);
  return errors;
}

std::string message_of(const std::string& file, const Bounds& bounds, const std::function<void(Packer&)>& work) {
  try {
    unpack_surface(isolated_answer(file, bounds, k_expected_surface, work), file);
    return "";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file));
    return error.what();
  }
}

bool has_landlock() {
  return !k_sanitized && ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
}

/// A model, a file below its folder and one beside it.
struct Place {
  fs::path folder = scratch_folder();
  std::string model = folder / "in/model.dae", below = folder / "in/below/part.bin", outside = folder / "secret";

  Place() {
    fs::create_directories(folder / "in/below");
    for (const std::string& file : {model, below, outside}) std::ofstream(file) << "text";
  }
};

TEST(ImportBox, NothingOfTheOutsideAnswers) {
  const Place place;
  const std::string other = place.folder / "in/other";
  const char* const model = place.model.c_str();
  const char* const to = other.c_str();
  const std::vector<Attempt> attempts = {
      {"socket", [] { return ::socket(AF_INET, SOCK_STREAM, 0); }},
      {"local socket", [] { return ::socket(AF_UNIX, SOCK_STREAM, 0); }},
      {"socketpair",
       [] {
         int ends[2];
         return ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends);
       }},
      {"connect", [] { return ::connect(k_pipe, nullptr, 0); }},
      {"sendto", [] { return ::sendto(k_pipe, "", 0, 0, nullptr, 0); }},
      {"fork",
       [] {
         const pid_t child = ::fork();
         if (child == 0) ::_exit(0);
         return child;
       }},
      {"clone3", [] { return ::syscall(SYS_clone3, nullptr, 0); }},
      {"execve", [] { return ::execl("/bin/true", "true", nullptr); }},
      {"execveat", [] { return ::syscall(SYS_execveat, AT_FDCWD, "/bin/true", nullptr, nullptr, 0); }},
      {"ptrace", [] { return ::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr); }},
      {"memory of another", [] { return ::syscall(SYS_process_vm_readv, ::getppid(), nullptr, 0, nullptr, 0, 0); }},
      {"signal to another", [] { return ::kill(::getppid(), 0); }},
      {"signal to all", [] { return ::kill(-1, 0); }},
      {"new file", [&] { return ::open(to, O_WRONLY | O_CREAT, 0600); }},
      {"new file read", [&] { return ::open(to, O_RDONLY | O_CREAT, 0600); }},
      {"write", [&] { return ::open(model, O_WRONLY); }},
      {"read and write", [&] { return ::open(model, O_RDWR); }},
      {"append", [&] { return ::open(model, O_WRONLY | O_APPEND); }},
      {"emptying", [&] { return ::open(model, O_RDONLY | O_TRUNC); }},
      {"openat2", [&] { return ::syscall(SYS_openat2, AT_FDCWD, model, nullptr, 0); }},
      {"truncate", [&] { return ::truncate(model, 0); }},
      {"unlink", [&] { return ::unlink(model); }},
      {"unlinkat", [&] { return ::unlinkat(AT_FDCWD, model, 0); }},
      {"rename", [&] { return ::rename(model, to); }},
      {"link", [&] { return ::link(model, to); }},
      {"symlink", [&] { return ::symlink(model, to); }},
      {"mkdir", [&] { return ::mkdir(to, 0700); }},
      {"mkfifo", [&] { return ::mkfifo(to, 0700); }},
      {"chmod", [&] { return ::chmod(model, 0777); }},
      {"chown", [&] { return ::chown(model, 1, 1); }},
      {"utimensat", [&] { return ::utimensat(AT_FDCWD, model, nullptr, 0); }},
      {"mount", [&] { return ::mount("none", to, "tmpfs", 0, nullptr); }},
      {"setuid", [] { return ::setuid(0); }},
      {"io_uring", [] { return ::syscall(SYS_io_uring_setup, 1, nullptr); }},
      {"more memory",
       [] {
         const rlimit all = {RLIM_INFINITY, RLIM_INFINITY};
         return ::setrlimit(RLIMIT_AS, &all);
       }},
  };
  for (const auto& [name, error] : errors_in_box(place.model, attempts)) EXPECT_EQ(error, EPERM) << name;
  EXPECT_FALSE(fs::exists(fs::symlink_status(other)));
  EXPECT_EQ(fs::file_size(place.model), 4u);
}

TEST(ImportBox, OnlyTheModelsFolderIsRead) {
  const Place place;
  fs::create_symlink(place.outside, place.folder / "in/link");
  const auto reading = [](const std::string& file) { return [file] { return ::open(file.c_str(), O_RDONLY); }; };
  const auto errors = errors_in_box(place.model, {{"model", reading(place.model)},
                                                  {"below", reading(place.below)},
                                                  {"outside", reading(place.outside)},
                                                  {"by a link", reading(place.folder / "in/link")},
                                                  {"by steps", reading(place.folder / "in/../secret")},
                                                  {"passwords", reading("/etc/passwd")},
                                                  {"itself", reading("/proc/self/mem")}});
  EXPECT_EQ(errors.at("model"), 0);
  EXPECT_EQ(errors.at("below"), 0);
  if (!has_landlock()) GTEST_SKIP() << "no Landlock in this kernel, or a sanitizer that needs more";
  for (const char* name : {"outside", "by a link", "by steps", "passwords", "itself"})
    EXPECT_EQ(errors.at(name), EACCES) << name;
}

TEST(ImportBox, AModelBehindALinkIsRead) {
  const Place place;
  const std::string link = place.folder / "in/link.dae";
  fs::create_symlink(place.outside, link);
  const auto errors = errors_in_box(link, {{"link", [&] { return ::open(link.c_str(), O_RDONLY); }},
                                           {"below", [&] { return ::open(place.below.c_str(), O_RDONLY); }}});
  EXPECT_EQ(errors.at("link"), 0);
  EXPECT_EQ(errors.at("below"), 0);
}

TEST(ImportBox, LimitsAreHardAndRightsCannotGrow) {
  const Place place;
  const auto hard = [](__rlimit_resource resource) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    return limit.rlim_max;
  };
  std::vector<rlim_t> limits;
  const std::string answer = isolated_answer(place.model, k_bounds, "an answer", [&](Packer& packer) {
    std::vector<rlim_t> found;
    for (const auto resource : {RLIMIT_CORE, RLIMIT_NPROC, RLIMIT_NOFILE, RLIMIT_CPU, RLIMIT_AS, RLIMIT_FSIZE})
      found.push_back(hard(resource));
    found.push_back(static_cast<rlim_t>(::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0)));
    pass(packer, found);
  });
  Unpacker unpacker(std::string_view(answer).substr(1));
  pass(unpacker, limits);
  ASSERT_EQ(limits.size(), 7u);
  EXPECT_EQ(limits[0], 0u);
  EXPECT_EQ(limits[1], 0u);
  EXPECT_EQ(limits[2], 16u);
  EXPECT_EQ(limits[3], k_bounds.seconds + 1);
  EXPECT_NE(limits[4], RLIM_INFINITY);
  EXPECT_EQ(limits[5], k_sanitized ? RLIM_INFINITY : 0u);
  EXPECT_EQ(limits[6], 1u);
}

TEST(ImportBox, NoDescriptorOfTheProgramGoesAlong) {
  const Place place;
  const int held = ::open(place.outside.c_str(), O_RDWR), far = ::dup2(held, 200);
  std::vector<int> open;
  const std::string answer = isolated_answer(place.model, k_bounds, "an answer", [&](Packer& packer) {
    std::vector<int> found;
    for (int d = 0; d < 1024; ++d)
      if (::fcntl(d, F_GETFD) >= 0) found.push_back(d);
    pass(packer, found);
  });
  Unpacker unpacker(std::string_view(answer).substr(1));
  pass(unpacker, open);
  EXPECT_THAT(open, ::testing::ElementsAre(0, 1, 2, k_pipe));
  ::close(held);
  ::close(far);
}

TEST(ImportBox, AReaderThatGoesWrongIsToldOf) {
  const Place place;
  const auto message = [&](const std::function<void(Packer&)>& work, const Bounds& bounds = k_bounds) {
    return message_of(place.model, bounds, work);
  };
  EXPECT_THAT(message([](Packer&) { std::abort(); }), HasSubstr("ends its reader by signal 6"));
  EXPECT_THAT(message([](Packer&) { ::_exit(0); }), HasSubstr("without an answer"));
  EXPECT_THAT(message([](Packer&) { ::_exit(1); }), HasSubstr("without an answer"));
  EXPECT_THAT(message([](Packer&) { ::pause(); }, {k_bounds.memory, 0}), HasSubstr("falls silent"));
  EXPECT_THAT(message([](Packer&) {
                ::close(k_pipe);
                ::pause();
              }),
              HasSubstr("signal 9"));
  EXPECT_THAT(message(
                  [](Packer&) {
                    const std::string noise(1 << 16, 'x');
                    while (::write(k_pipe, noise.data(), noise.size()) > 0) {
                    }
                  },
                  {1 << 24, 5}),
              HasSubstr("answers without end"));
  EXPECT_THAT(message(
                  [](Packer&) {
                    for (;;) ::getppid();
                  },
                  {k_bounds.memory, 1}),
              HasSubstr("after too long a time"));
  EXPECT_EQ(::waitpid(-1, nullptr, 0), -1) << "a child was left behind";
}

TEST(ImportBox, WantOfMemoryIsToldOf) {
  if (k_sanitized) GTEST_SKIP() << "a sanitizer's allocator ends the program";
  const Place place;
  const auto message = [&](const std::function<void(Packer&)>& work) {
    return message_of(place.model, {1 << 26, 5}, work);
  };
  EXPECT_THAT(message([](Packer& packer) {
                std::vector<int> large(1 << 28);
                pass(packer, large);
              }),
              HasSubstr("takes more memory to read than there is"));
  EXPECT_THAT(message([](Packer& packer) { // the answer itself has no room
                std::vector<char> large(40 << 20);
                pass(packer, large);
              }),
              HasSubstr("memory"));
  const std::string parent = message_in_process([&] {
    const rlimit little = {std::uintmax_t{400} << 20, std::uintmax_t{400} << 20};
    ::setrlimit(RLIMIT_AS, &little);
    try {
      isolated_answer(place.model, k_bounds, k_expected_surface, [](Packer&) {
        const std::string noise(1 << 20, 'x');
        for (int i = 0; i < 1000; ++i) ::write(k_pipe, noise.data(), noise.size());
        ::_exit(0);
      });
    } catch (...) {
      rethrow_as_input_error(place.model, k_expected_surface);
    }
  });
  EXPECT_THAT(parent, HasSubstr(place.model));
  EXPECT_THAT(parent, HasSubstr("takes more memory to read than there is"));
}

TEST(ImportBox, WithoutAProcessOfItsOwnNothingIsRead) {
  const fs::path model = write_text("tiny.dae", collada_text(upright()));
  EXPECT_EQ(message_in_process([&] { import_character(model); }), "");
  Watch watch(model);
  const std::string no_pipe = message_in_process([&] {
    const rlimit none = {0, 0};
    ::setrlimit(RLIMIT_NOFILE, &none);
    import_character(model);
  });
  EXPECT_THAT(no_pipe, HasSubstr(model.string()));
  EXPECT_THAT(no_pipe, HasSubstr("no pipe to a process that reads it: Too many open files"));
  const std::string no_process = message_in_process([&] {
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    refuse_calls();
    import_character(model);
  });
  EXPECT_THAT(no_process, HasSubstr(model.string()));
  EXPECT_THAT(no_process, HasSubstr("no process to read it in: Operation not permitted"));
  EXPECT_FALSE(watch.saw_it_opened());
  std::ifstream{model};
  EXPECT_TRUE(watch.saw_it_opened());
}

} // namespace
