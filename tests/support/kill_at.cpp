// Preloaded into the program (LD_PRELOAD): kills it, as kill -9 would, at a chosen call of a function by which files
// are written. KILL_AT is "FUNCTION:N": at its N-th call, before anything of it is done.
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <sys/types.h>
#include <sys/uio.h>

namespace {

void reached(const char* function) {
  static const char* const wanted = std::getenv("KILL_AT");
  static int calls = 0;
  const char* colon = wanted ? std::strchr(wanted, ':') : nullptr;
  if (!colon || std::strncmp(wanted, function, static_cast<std::size_t>(colon - wanted)) != 0) return;
  if (function[colon - wanted] == 0 && ++calls == std::atoi(colon + 1)) ::raise(SIGKILL);
}

template <class F> F next(const char* name) { return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name)); }

} // namespace

extern "C" {

int mkostemps(char* name, int suffix, int flags) {
  reached("mkostemps");
  static const auto real = next<int (*)(char*, int, int)>("mkostemps");
  return real(name, suffix, flags);
}

int fsync(int descriptor) {
  reached("fsync");
  static const auto real = next<int (*)(int)>("fsync");
  return real(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  reached("rename");
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return real(from, to);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  if (descriptor > 2) reached("write");
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  return real(descriptor, bytes, count);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  if (descriptor > 2) reached("write");
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  return real(descriptor, parts, count);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at) {
  reached("pwrite");
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return real(descriptor, bytes, count, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t at) {
  reached("pwrite");
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  return real(descriptor, bytes, count, at);
}

} // extern "C"
