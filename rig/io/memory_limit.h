// How much memory may be taken by what a file describes: estimated, and held against a limit, before it is allocated.
#pragma once

#include "rig/error.h"

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>

namespace tutu {

/// Bytes that one description may take: 2 GiB, or what the environment variable TUTU_MEMORY_GIB says, a number above 0.
/// Throws InputError where it says something else.
double memory_limit();

/// Throws InputError where `bytes`, an estimate, are more than the limit. `what` would take them: "a garment of 5
/// particles".
void check_memory(double bytes, const std::string& file, const std::string& place, const std::string& what);

/// 16777216 -> "16,777,216".
std::string with_commas(std::uint64_t number);

/// Of `file`, in memory that could not be had.
InputError out_of_memory(const std::string& file);

/// What `make` gives. Where memory runs out in it, that is told of `file`, which is what it reads or builds.
template <class Make> decltype(auto) within_memory(const std::string& file, const Make& make) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    throw out_of_memory(file);
  } catch (const std::length_error&) { // of a container, asked for more than there are addresses
    throw out_of_memory(file);
  }
}

} // namespace tutu
