/* OpenStreetMap as XML: what is given to the sink is whole, whatever the file. */
#include "osm.h"

const uint32_t fuzz_mutations = 20000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_osm(data, size, osm_xml_read);
}
