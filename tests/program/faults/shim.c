/* Faults in the system calls by which a program changes a folder; to be preloaded.
 *
 * FAULT_IN     the folder; calls for other paths are left alone
 * FAULT_KIND   "none", "kill", "full" (from the call on nothing has room) or "broken" (the call alone fails)
 * FAULT_AT     the number of the call, from 1
 * FAULT_LOG    a file that gets a line for every call
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

static int calls;

static const char *setting(const char *name) {
    const char *value = getenv(name);
    return value ? value : "";
}

/* What is to become of a call: 0 nothing, or an error number. */
static int fault(const char *what, const char *path, int needs_room) {
    const char *folder = setting("FAULT_IN"), *kind = setting("FAULT_KIND");
    size_t length = strlen(folder);
    if (length == 0 || strncmp(path, folder, length) != 0) return 0;
    int number = __atomic_add_fetch(&calls, 1, __ATOMIC_SEQ_CST), at = atoi(setting("FAULT_AT"));
    char line[2 * PATH_MAX];
    int size = snprintf(line, sizeof line, "%s %s\n", what, path);
    int log = syscall(SYS_openat, AT_FDCWD, setting("FAULT_LOG"), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (log >= 0) {
        syscall(SYS_write, log, line, size);
        syscall(SYS_close, log);
    }
    if (number < at) return 0;
    if (strcmp(kind, "kill") == 0) return number == at ? -1 : 0;
    if (strcmp(kind, "full") == 0) return needs_room ? ENOSPC : 0;
    if (strcmp(kind, "broken") == 0) return number == at ? EIO : 0;
    return 0;
}

static int refused(int error) {
    if (error == 0) return 0;
    if (error < 0) raise(SIGKILL);
    errno = error;
    return 1;
}

static int faulty(const char *what, const char *path, int needs_room) {
    return refused(fault(what, path, needs_room));
}

static int fault_of(const char *what, int file, int needs_room) {
    char link[64], path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = 0;
    return fault(what, path, needs_room);
}

#define REAL(type, name) ((type)dlsym(RTLD_NEXT, name))

#define OPEN(name)                                                                  \
    int name(const char *path, int flags, ...) {                                    \
        va_list rest;                                                               \
        va_start(rest, flags);                                                      \
        mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;                   \
        va_end(rest);                                                               \
        if (faulty(flags & O_CREAT ? "create" : "open", path, flags & O_CREAT)) return -1; \
        return REAL(int (*)(const char *, int, mode_t), #name)(path, flags, mode);  \
    }
OPEN(open)
OPEN(open64)

ssize_t write(int file, const void *bytes, size_t count) {
    ssize_t (*real)(int, const void *, size_t) = REAL(ssize_t(*)(int, const void *, size_t), "write");
    int error = fault_of("write", file, 1);
    if (error != 0) {
        /* A part is written before the disk is full or the program is gone. */
        if (count > 1) real(file, bytes, count / 2);
        refused(error);
        return -1;
    }
    return real(file, bytes, count);
}

#define ON_FILE(name, needs_room, parameters, arguments)                            \
    int name parameters {                                                           \
        if (refused(fault_of(#name, file, needs_room))) return -1;                  \
        return REAL(int(*) parameters, #name) arguments;                            \
    }
ON_FILE(fsync, 1, (int file), (file))
ON_FILE(fdatasync, 1, (int file), (file))
ON_FILE(fchmod, 0, (int file, mode_t mode), (file, mode))
ON_FILE(fchown, 0, (int file, uid_t user, gid_t group), (file, user, group))
ON_FILE(ftruncate64, 0, (int file, off64_t length), (file, length))

#define ON_PATH(name, needs_room, parameters, arguments)                            \
    int name parameters {                                                           \
        if (faulty(#name, path, needs_room)) return -1;                             \
        return REAL(int(*) parameters, #name) arguments;                            \
    }
ON_PATH(rename, 1, (const char *path, const char *to), (path, to))
ON_PATH(unlink, 0, (const char *path), (path))
ON_PATH(mkdir, 1, (const char *path, mode_t mode), (path, mode))
