/*
 * Answers /dev/i2c-N by a socket, so that a program runs on an emulated bus. Load it with LD_PRELOAD. The variable
 * VIBRISSA_I2C has the path of the socket. Request: bus, address, two lengths, written bytes. Answer: an error number,
 * then the read bytes. Numbers are 32 bits in the byte order of the machine.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define FILES 1024
static int bus_of[FILES]; /* number of the bus plus one */
static uint32_t slave_of[FILES];

static int is_bus(int file) { return file >= 0 && file < FILES && bus_of[file] != 0; }

static ssize_t (*real_read)(int, void *, size_t);
static ssize_t (*real_write)(int, const void *, size_t);

static int transfer_all(int file, void *bytes, size_t length, int writes) {
    char *next = bytes;
    while (length > 0) {
        ssize_t done = writes ? real_write(file, next, length) : real_read(file, next, length);
        if (done <= 0) return -1;
        next += done;
        length -= (size_t)done;
    }
    return 0;
}

static int transfer(int file, uint32_t address, const void *out, uint32_t out_length, void *in, uint32_t in_length) {
    uint32_t head[4] = {(uint32_t)bus_of[file] - 1, address, out_length, in_length};
    int32_t error = 0;
    if (transfer_all(file, head, sizeof head, 1) || transfer_all(file, (void *)out, out_length, 1) ||
        transfer_all(file, &error, sizeof error, 0) || (error == 0 && transfer_all(file, in, in_length, 0)))
        error = EIO;
    if (error != 0) { errno = error; return -1; }
    return 0;
}

static int open_bus(const char *path) {
    struct sockaddr_un name = {.sun_family = AF_UNIX};
    const char *socket_path = getenv("VIBRISSA_I2C");
    int file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (file < 0 || file >= FILES || socket_path == NULL) return -1;
    strncpy(name.sun_path, socket_path, sizeof name.sun_path - 1);
    if (connect(file, (struct sockaddr *)&name, sizeof name) != 0) { close(file); errno = ENOENT; return -1; }
    real_read = dlsym(RTLD_NEXT, "read");
    real_write = dlsym(RTLD_NEXT, "write");
    bus_of[file] = atoi(path + strlen("/dev/i2c-")) + 1;
    return file;
}

#define OPEN(name)                                                                  \
    int name(const char *path, int flags, ...) {                                   \
        if (strncmp(path, "/dev/i2c-", strlen("/dev/i2c-")) == 0) return open_bus(path); \
        va_list rest;                                                               \
        va_start(rest, flags);                                                      \
        int mode = va_arg(rest, int);                                               \
        va_end(rest);                                                               \
        int (*real)(const char *, int, ...) = dlsym(RTLD_NEXT, #name);              \
        return real(path, flags, mode);                                             \
    }
OPEN(open)
OPEN(open64)

int close(int file) {
    if (is_bus(file)) bus_of[file] = 0;
    int (*real)(int) = dlsym(RTLD_NEXT, "close");
    return real(file);
}

int ioctl(int file, unsigned long request, ...) {
    va_list rest;
    va_start(rest, request);
    void *argument = va_arg(rest, void *);
    va_end(rest);
    if (!is_bus(file)) {
        int (*real)(int, unsigned long, ...) = dlsym(RTLD_NEXT, "ioctl");
        return real(file, request, argument);
    }
    switch (request) {
    case I2C_SLAVE:
    case I2C_SLAVE_FORCE: slave_of[file] = (uint32_t)(uintptr_t)argument; return 0;
    case I2C_FUNCS: *(unsigned long *)argument = I2C_FUNC_I2C; return 0;
    case I2C_RDWR: {
        struct i2c_rdwr_ioctl_data *data = argument;
        struct i2c_msg *write = &data->msgs[0], *read = &data->msgs[1];
        if (data->nmsgs != 2 || (write->flags & I2C_M_RD) || !(read->flags & I2C_M_RD)) { errno = EOPNOTSUPP; return -1; }
        return transfer(file, write->addr, write->buf, write->len, read->buf, read->len) ? -1 : 2;
    }
    default: errno = EOPNOTSUPP; return -1;
    }
}

ssize_t write(int file, const void *bytes, size_t length) {
    if (is_bus(file)) return transfer(file, slave_of[file], bytes, (uint32_t)length, NULL, 0) ? -1 : (ssize_t)length;
    if (real_write == NULL) real_write = dlsym(RTLD_NEXT, "write");
    return real_write(file, bytes, length);
}

ssize_t read(int file, void *bytes, size_t length) {
    if (is_bus(file)) return transfer(file, slave_of[file], NULL, 0, bytes, (uint32_t)length) ? -1 : (ssize_t)length;
    if (real_read == NULL) real_read = dlsym(RTLD_NEXT, "read");
    return real_read(file, bytes, length);
}
