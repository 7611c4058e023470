#include "host.h"

enum {
    SYS_OPEN = 0x01,
    SYS_WRITE0 = 0x04,
    SYS_READ = 0x06,
    SYS_SEEK = 0x0A,
    SYS_FLEN = 0x0C,
    SYS_EXIT_EXTENDED = 0x20,
    OPEN_READ_BINARY = 1
};
#define STOPPED_APPLICATION_EXIT 0x20026u

static int call(uint32_t operation, const void *parameters)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = parameters;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return (int)r0;
}

void host_say(const char *words)
{
    call(SYS_WRITE0, words);
}

static void say_hex(uint32_t number)
{
    char digits[] = " 00000000";
    for (uint32_t i = 0; i < 8; i++) {
        digits[8 - i] = "0123456789abcdef"[number >> 4 * i & 15];
    }
    host_say(digits);
}

void host_say_checksums(const char *name, uint32_t first, uint32_t second)
{
    host_say(name);
    say_hex(first);
    say_hex(second);
    host_say("\n");
}

void host_say_number(uint32_t number)
{
    char digits[11] = {0};
    uint32_t at = sizeof digits - 1;
    do {
        digits[--at] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    host_say(digits + at);
}

_Noreturn void host_exit(int status)
{
    const uint32_t parameters[2] = {STOPPED_APPLICATION_EXIT, (uint32_t)status};
    for (;;) {
        call(SYS_EXIT_EXTENDED, parameters);
    }
}

int host_open(const char *path)
{
    uint32_t length = 0;
    while (path[length]) {
        length++;
    }
    const uint32_t parameters[3] = {(uint32_t)(uintptr_t)path, OPEN_READ_BINARY, length};
    return call(SYS_OPEN, parameters);
}

bool host_length(int handle, uint32_t *bytes)
{
    const uint32_t parameters[1] = {(uint32_t)handle};
    const int length = call(SYS_FLEN, parameters);
    *bytes = (uint32_t)length;
    return length >= 0;
}

bool host_read(int handle, uint32_t offset, void *to, uint32_t length)
{
    const uint32_t place[2] = {(uint32_t)handle, offset};
    const uint32_t parameters[3] = {(uint32_t)handle, (uint32_t)(uintptr_t)to, length};
    return call(SYS_SEEK, place) == 0 && call(SYS_READ, parameters) == 0;
}
