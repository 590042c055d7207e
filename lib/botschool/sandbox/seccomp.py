"""A seccomp filter, in classic BPF: the system calls that untrusted code may not make.

It covers what Landlock does not: processes, sockets, signals and scheduling of others, modes,
owners and times of files, memory that outlives or evades the limits. See linux/seccomp.h.
"""

from __future__ import annotations

import ctypes
import errno
import platform
import struct
import sys

# name: (number on x86_64, number on aarch64); None where there is no such call
_REFUSED = {
    # other programs and processes
    "fork": (57, None), "vfork": (58, None), "execve": (59, 221), "execveat": (322, 281),
    "ptrace": (101, 117), "process_vm_readv": (310, 270), "process_vm_writev": (311, 271),
    "process_madvise": (440, 440), "pidfd_open": (434, 434), "pidfd_getfd": (438, 438),
    "kcmp": (312, 272), "unshare": (272, 97), "setns": (308, 268),
    # signals and scheduling of others
    "tkill": (200, 130), "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240),
    "pidfd_send_signal": (424, 424), "setpriority": (141, 140), "prlimit64": (302, 261),
    "sched_setaffinity": (203, 122), "sched_setscheduler": (144, 119),
    "sched_setparam": (142, 118), "sched_setattr": (314, 274), "ioprio_set": (251, 30),
    "migrate_pages": (256, 238), "move_pages": (279, 239),
    # the network, and whatever listens on this machine
    "socket": (41, 198), "socketpair": (53, 199), "io_uring_setup": (425, 425),
    # files by other ways than Landlock sees (truncate: before its third version)
    "truncate": (76, 45), "open_by_handle_at": (304, 265), "mount": (165, 40),
    "umount2": (166, 39), "pivot_root": (155, 41), "chroot": (161, 51), "swapon": (167, 224),
    "swapoff": (168, 225), "acct": (163, 89), "quotactl": (179, 60),
    "quotactl_fd": (443, 443), "sync": (162, 81),
    # memory, messages and semaphores shared with others (System V, POSIX)
    "shmget": (29, 194), "shmat": (30, 196), "shmctl": (31, 195), "shmdt": (67, 197),
    "semget": (64, 190), "semop": (65, 193), "semctl": (66, 191), "semtimedop": (220, 192),
    "msgget": (68, 186), "msgsnd": (69, 189), "msgrcv": (70, 188), "msgctl": (71, 187),
    "mq_open": (240, 180), "mq_unlink": (241, 181), "mq_timedsend": (242, 182),
    "mq_timedreceive": (243, 183), "mq_notify": (244, 184), "mq_getsetattr": (245, 185),
    # watching what others do with files
    "inotify_init": (253, None), "inotify_init1": (294, 26), "inotify_add_watch": (254, 27),
    "inotify_rm_watch": (255, 28), "fanotify_init": (300, 262), "fanotify_mark": (301, 263),
    # what keeps removed files on the disk unseen: rules (of Landlock) and requests (aio) hold them
    "landlock_create_ruleset": (444, 444), "landlock_add_rule": (445, 445),
    "landlock_restrict_self": (446, 446), "io_setup": (206, 0),
    # memory that outlives the process or escapes its limits
    "memfd_create": (319, 279), "memfd_secret": (447, 447), "add_key": (248, 217),
    "request_key": (249, 218), "keyctl": (250, 219),
    # the kernel itself
    "bpf": (321, 280), "perf_event_open": (298, 241), "userfaultfd": (323, 282),
    "kexec_load": (246, 104), "kexec_file_load": (320, 294), "process_mrelease": (448, 448),
    "modify_ldt": (154, None), "init_module": (175, 105), "finit_module": (313, 273),
    "delete_module": (176, 106), "reboot": (169, 142), "settimeofday": (164, 170),
    "clock_settime": (227, 112), "adjtimex": (159, 171), "clock_adjtime": (305, 266),
    "sethostname": (170, 161), "setdomainname": (171, 162), "syslog": (103, 116),
    "iopl": (172, None), "ioperm": (173, None),
}  # fmt: skip
# These change files that Landlock leaves open to it: they seem to succeed, and do nothing.
_PRETENDED = {
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "fchown": (93, 55), "lchown": (94, None), "fchownat": (260, 54),
    "utime": (132, None), "utimes": (235, None), "futimesat": (261, None),
    "utimensat": (280, 88), "setxattr": (188, 5), "lsetxattr": (189, 6), "fsetxattr": (190, 7),
    "removexattr": (197, 14), "lremovexattr": (198, 15), "fremovexattr": (199, 16),
    "setxattrat": (463, 463), "removexattrat": (466, 466), "file_setattr": (469, 469),
}  # fmt: skip
_CONDITIONAL = {
    "clone": (56, 220), "clone3": (435, 435), "kill": (62, 129), "tgkill": (234, 131),
    "ioctl": (16, 29), "fcntl": (72, 25), "prctl": (157, 167), "fallocate": (285, 47),
}  # fmt: skip

_CLONE_FILES, _CLONE_THREAD = 0x400, 0x10000
_IOCTLS = (0x5401, 0x5413, 0x541B, 0x5421, 0x5450, 0x5451)
"""isatty, window size, bytes to read, non-blocking, close-on-exec."""
_FCNTLS = (8, 10, 15, 1024, 1026)
"""F_SETOWN, F_SETSIG, F_SETOWN_EX (they send signals to others), F_SETLEASE, F_NOTIFY."""
_PRCTLS = (1, 4)
"""PR_SET_PDEATHSIG, PR_SET_DUMPABLE (the caller could no longer see open files)."""

_LOAD, _EQUAL, _AT_LEAST, _ANY_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_NUMBER, _ARCHITECTURE, _FIRST, _SECOND = 0, 4, 16, 24  # offsets in seccomp_data
_MACHINES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}

Instruction = tuple[int, int, int, int]
_ALLOW: Instruction = (_RETURN, 0, 0, 0x7FFF0000)
_KILL: Instruction = (_RETURN, 0, 0, 0x80000000)


def _fail(number: int) -> Instruction:
    return (_RETURN, 0, 0, 0x00050000 | number)


_REFUSE, _PRETEND, _UNKNOWN = _fail(errno.EPERM), _fail(0), _fail(errno.ENOSYS)


def program(machine: str, pid: int) -> list[Instruction] | None:
    """The filter for a process; None for a machine that is not known."""
    if machine not in _MACHINES or sys.maxsize < 2**32:
        return None
    column, architecture = _MACHINES[machine]
    code = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, architecture),
        _KILL,  # 32-bit calls
        (_LOAD, 0, 0, _NUMBER),
        (_AT_LEAST, 0, 1, 0x40000000),
        _REFUSE,  # the x32 calls
    ]
    for calls, answer in ((_REFUSED, _REFUSE), (_PRETENDED, _PRETEND)):
        for numbers in calls.values():
            if numbers[column] is not None:
                code += _when(numbers[column], [answer])
    number = {name: numbers[column] for name, numbers in _CONDITIONAL.items()}
    # clone3 hides its flags in memory: the C library falls back to clone
    code += _when(number["clone3"], [_UNKNOWN])
    # no processes, and no threads with open files of their own, which the caller would not see
    threads = [(_LOAD, 0, 0, _FIRST), (_ANY_BIT, 0, 2, _CLONE_THREAD)]
    code += _when(number["clone"], [*threads, (_ANY_BIT, 0, 1, _CLONE_FILES), _ALLOW, _REFUSE])
    # it fills the disk at once: the C library then writes, which takes its time
    code += _when(number["fallocate"], [_fail(errno.EOPNOTSUPP)])
    for name in ("kill", "tgkill"):
        code += _when(number[name], _arguments(_FIRST, (pid,), _ALLOW, _REFUSE))
    code += _when(number["ioctl"], _arguments(_SECOND, _IOCTLS, _ALLOW, _fail(errno.ENOTTY)))
    code += _when(number["fcntl"], _arguments(_SECOND, _FCNTLS, _REFUSE, _ALLOW))
    code += _when(number["prctl"], _arguments(_FIRST, _PRCTLS, _REFUSE, _ALLOW))
    return [*code, _ALLOW]


def _when(number: int, then: list[Instruction]) -> list[Instruction]:
    """For this call; `then` must end with an answer."""
    return [(_EQUAL, 0, len(then), number), *then]


def _arguments(
    offset: int, values: tuple[int, ...], listed: Instruction, other: Instruction
) -> list[Instruction]:
    code = [(_LOAD, 0, 0, offset)]
    for value in values:
        code += [(_EQUAL, 0, 1, value), listed]
    return [*code, other]


def install(libc: ctypes.CDLL, code: list[Instruction]) -> bool:
    """Puts the filter on every thread of this process (no new privileges must be set)."""
    buffer = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *line) for line in code))
    filter_ = ctypes.create_string_buffer(
        struct.pack("HxxxxxxQ", len(code), ctypes.addressof(buffer))
    )
    call = {"x86_64": 317, "aarch64": 277}[platform.machine()]
    if libc.syscall(call, 1, 1, filter_) == 0:  # filter, all threads
        return True
    return libc.prctl(22, 2, filter_, 0, 0) == 0  # kernels before 3.17: this thread
