"""Reads, overwrites and removes another program's shared memory; makes its own, and queues."""

import ctypes


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None, use_errno=True)
    libc.shmat.restype = ctypes.c_void_p
    libc.shmat.argtypes = (ctypes.c_int, ctypes.c_void_p, ctypes.c_int)
    for segment in (SEGMENT, libc.shmget(0x5EC2E7, 4096, 0o1666)):
        address = libc.shmat(segment, None, 0)
        if address not in (None, ctypes.c_void_p(-1).value):
            print("LEAKED", ctypes.string_at(address, 20))
            ctypes.memmove(address, b"hostile", 8)
        libc.shmctl(segment, 0, None)  # IPC_RMID
    made = {
        "a message queue": libc.msgget(0x5EC2E7, 0o1666),
        "semaphores": libc.semget(0x5EC2E7, 1, 0o1666),
        "a POSIX queue": libc.mq_open(b"/hostile", 0o102, 0o666, None),
        "inotify": libc.inotify_init1(0),
        "fanotify": libc.fanotify_init(0x200, 0),
    }
    for name, number in made.items():
        if number >= 0:
            print("LEAKED", name)
    libc.msgctl(made["a message queue"], 0, None)  # IPC_RMID
    libc.semctl(made["semaphores"], 0, 0, None)
    libc.mq_unlink(b"/hostile")
    return 0
