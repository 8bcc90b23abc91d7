// Private to the importer's box.
#pragma once

namespace tutu::rig::import_detail {

/// From now on what reading a file never needs of the kernel answers EPERM in this process (box.h says what). Needs
/// no_new_privs. Does nothing on other processors than x86-64 and aarch64 and where the kernel has no such filters.
/// Throws std::system_error when a kernel that has them refuses this one.
void refuse_calls();

} // namespace tutu::rig::import_detail
