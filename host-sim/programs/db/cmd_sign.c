#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/verify.h"
#include "signature.h"
#include "trust/sign.h"

#include <inttypes.h>
#include <stdio.h>

static const struct hs_usage usage = {
    "sign", "sign a database image with a key of Ed25519",
    "Writes the image again with a signature over each bit of it. A signature that it has is "
    "replaced. The image must be\n"
    "without faults. The signed one is put in place whole or not at all; FILE stays as it is and "
    "may not be SIGNED.\n"
    "\n"
    "To make a key and what others need to check by:\n"
    "\n"
    "    openssl genpkey -algorithm ed25519 -aes256 -out signing.pem\n"
    "    openssl pkey -in signing.pem -pubout -out public.pem\n"
    "\n"
    "A panel refuses an image whose serial number is below one that it has flown."};

static int check_old(const char *path)
{
    struct image image;
    struct image_findings findings = {stderr, 0, 10, false, NULL};
    struct image_verify_counts counts;
    if (image_map(&image, path) != 0) {
        return -1;
    }
    const bool is_complete = image_verify(&image, &findings, &counts) == 0;
    image_close(&image);
    return is_complete && findings.count == 0
               ? 0
               : hs_error(path, "sign a sound copy of it, or build it again",
                          "has %" PRIu64 " faults", findings.count);
}

static int tell_new(const char *path)
{
    struct image image;
    if (image_map(&image, path) != 0) {
        return -1;
    }
    printf("%s: %" PRIu64 " bytes\n", path, image.size_bytes);
    hs_report_count("bytes", image.size_bytes);
    db_signature_print(&image);
    image_close(&image);
    return 0;
}

static int sign(const char *from, const char *to, const char *key, const char *password,
                uint64_t serial)
{
    struct trust_signer signer;
    if (trust_signer_load(&signer, key, password) != 0 || check_old(from) != 0) {
        trust_signer_forget(&signer);
        return -1;
    }
    const int result = trust_sign_image(from, to, &signer, serial);
    trust_signer_forget(&signer);
    return result == 0 ? tell_new(to) : -1;
}

int db_cmd_sign(int argc, char **argv)
{
    const char *from = NULL, *to = NULL, *key = NULL, *password = NULL;
    long serial = -1;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &from, 0, 0, NULL, "the image to sign", true},
        {"SIGNED", HS_OUTPUT_ARGUMENT, &to, 0, 0, NULL, "the image to write", true},
        {"key", HS_INPUT, &key, 0, 0, "FILE", "private key of Ed25519, in PEM form", true},
        {"password", HS_INPUT, &password, 0, 0, "FILE",
         "file whose first line is the password of that key; left out: it has none", false},
        {"serial", HS_INTEGER, &serial, 0, 4294967295.0, "N",
         "serial number of the image: higher than that of the one it takes the place of", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (serial < 0) {
        return hs_options_wrong(&usage, "--serial", "is missing: a panel tells newer images by it");
    }
    return sign(from, to, key, password, (uint64_t)serial) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
