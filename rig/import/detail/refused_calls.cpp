// A list of what is refused rather than of what is allowed: what a C library, an allocator and a sanitizer ask for
// while they only read and reckon changes from version to version, what reaches out of a process does not.
#include "rig/import/detail/refused_calls.h"

#if defined(__x86_64__) || defined(__aarch64__)

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace tutu::rig::import_detail {
namespace {

#ifdef __x86_64__
constexpr std::uint32_t k_processor = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t k_processor = AUDIT_ARCH_AARCH64;
#endif

constexpr int k_refused[] = {
    // network, and talk between processes
    SYS_socket, SYS_socketpair, SYS_bind, SYS_listen, SYS_connect, SYS_accept, SYS_accept4, SYS_sendto, SYS_sendmsg,
    SYS_sendmmsg, SYS_mq_open, SYS_mq_unlink, SYS_msgget, SYS_semget, SYS_shmget, SYS_shmat,
    // processes and programs
    SYS_clone, SYS_clone3, SYS_execve, SYS_execveat, SYS_ptrace, SYS_process_vm_readv, SYS_process_vm_writev,
    SYS_process_madvise, SYS_pidfd_open, SYS_pidfd_getfd, SYS_pidfd_send_signal, SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo, SYS_kcmp, SYS_setpgid, SYS_setsid, SYS_setpriority, SYS_setrlimit,
    // files: making, changing, removing
    SYS_openat2, SYS_mknodat, SYS_mkdirat, SYS_unlinkat, SYS_renameat, SYS_renameat2, SYS_linkat, SYS_symlinkat,
    SYS_truncate, SYS_ftruncate, SYS_fallocate, SYS_fchmod, SYS_fchmodat, SYS_fchown, SYS_fchownat, SYS_utimensat,
    SYS_setxattr, SYS_lsetxattr, SYS_fsetxattr, SYS_removexattr, SYS_lremovexattr, SYS_fremovexattr, SYS_memfd_create,
    SYS_ioctl, SYS_name_to_handle_at, SYS_open_by_handle_at, SYS_inotify_init1, SYS_fanotify_init,
    // the machine
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_fsopen, SYS_fsconfig, SYS_fsmount, SYS_fspick,
    SYS_move_mount, SYS_open_tree, SYS_mount_setattr, SYS_setns, SYS_unshare, SYS_swapon, SYS_swapoff, SYS_quotactl,
    SYS_reboot, SYS_kexec_load, SYS_kexec_file_load, SYS_init_module, SYS_finit_module, SYS_delete_module,
    SYS_settimeofday, SYS_clock_settime, SYS_clock_adjtime, SYS_adjtimex, SYS_sethostname, SYS_setdomainname, SYS_acct,
    SYS_syslog, SYS_vhangup,
    // keys, other identities, and ways around a filter
    SYS_add_key, SYS_request_key, SYS_keyctl, SYS_setuid, SYS_setgid, SYS_setreuid, SYS_setregid, SYS_setresuid,
    SYS_setresgid, SYS_setfsuid, SYS_setfsgid, SYS_setgroups, SYS_capset, SYS_bpf, SYS_perf_event_open, SYS_userfaultfd,
    SYS_io_uring_setup, SYS_io_uring_enter, SYS_io_uring_register};

#ifdef __x86_64__ // older forms, which aarch64 never had
constexpr int k_refused_of_old[] = {SYS_fork,      SYS_vfork,        SYS_creat,  SYS_mknod,  SYS_mkdir,
                                    SYS_rmdir,     SYS_unlink,       SYS_rename, SYS_link,   SYS_symlink,
                                    SYS_chmod,     SYS_chown,        SYS_lchown, SYS_utime,  SYS_utimes,
                                    SYS_futimesat, SYS_inotify_init, SYS_iopl,   SYS_ioperm, SYS_modify_ldt};
#endif

constexpr std::uint32_t k_writes = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;

constexpr std::uint32_t k_refuse = SECCOMP_RET_ERRNO | EPERM;

/// A program that the kernel runs before every call. Its one register holds the call's number between two rules.
class Filter {
public:
  Filter() {
    step(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch));
    step(BPF_JMP | BPF_JEQ | BPF_K, k_processor, 1, 0);
    step(BPF_RET | BPF_K, k_refuse); // the calls of another processor have other numbers
    load_number();
#ifdef __x86_64__
    constexpr std::uint32_t k_x32 = 0x40000000; // the same calls under other numbers
    step(BPF_JMP | BPF_JGE | BPF_K, k_x32, 0, 1);
    step(BPF_RET | BPF_K, k_refuse);
#endif
  }

  void refuse(int call) {
    step(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1);
    step(BPF_RET | BPF_K, k_refuse);
  }
  /// Words are halves of arguments: 2 * argument is the lower one.
  void refuse_any_of(std::uint32_t bits, int call, unsigned word) { refuse_when(call, word, BPF_JSET, bits, 0, 1); }
  void refuse_unless(std::uint32_t value, int call, unsigned word) { refuse_when(call, word, BPF_JEQ, value, 1, 0); }

  void install() {
    step(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    const sock_fprog program = {static_cast<unsigned short>(steps_.size()), steps_.data()};
    if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) != 0 && errno != EINVAL && errno != ENOSYS)
      throw std::system_error(errno, std::generic_category(), "seccomp");
  }

private:
  void step(unsigned what, std::size_t value, std::uint8_t yes = 0, std::uint8_t no = 0) {
    steps_.push_back({static_cast<std::uint16_t>(what), yes, no, static_cast<std::uint32_t>(value)});
  }
  void load_number() { step(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)); }
  void refuse_when(int call, unsigned word, unsigned test, std::uint32_t value, std::uint8_t yes, std::uint8_t no) {
    step(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    step(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args) + 4 * word);
    step(BPF_JMP | test | BPF_K, value, yes, no);
    step(BPF_RET | BPF_K, k_refuse);
    load_number();
  }

  std::vector<sock_filter> steps_;
};

} // namespace

void refuse_calls() {
  Filter filter;
  for (const int call : k_refused) filter.refuse(call);
  filter.refuse_any_of(k_writes, SYS_openat, 4);
#ifdef __x86_64__
  for (const int call : k_refused_of_old) filter.refuse(call);
  filter.refuse_any_of(k_writes, SYS_open, 2);
#endif
  const auto self = static_cast<std::uint32_t>(::getpid()); // abort() signals itself
  for (const int call : {SYS_kill, SYS_tgkill, SYS_tkill}) filter.refuse_unless(self, call, 0);
  for (const unsigned half : {4u, 5u}) filter.refuse_unless(0, SYS_prlimit64, half); // asking is fine, setting is not
  filter.install();
}

} // namespace tutu::rig::import_detail

#else

namespace tutu::rig::import_detail {
void refuse_calls() {}
} // namespace tutu::rig::import_detail

#endif
