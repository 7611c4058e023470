/* Draw the golden pictures with the module of tests/web/golden.c: the lines of pictures.golden. */

const PLACE_BYTES = 40, HEAD_BYTES = 8; // struct golden_flash (tests/zcu102/golden_flash.h)

export function placesOf(flash) {
    const view = new DataView(flash);
    return [0, 1, 2, 3].map((n) => {
        const at = HEAD_BYTES + n * PLACE_BYTES, name = new Uint8Array(flash, at, 16);
        return {
            name: String.fromCharCode(...name.subarray(0, name.indexOf(0))),
            latitude: view.getUint32(at + 16, true),
            longitude: view.getUint32(at + 20, true),
            offset: Number(view.getBigUint64(at + 24, true)),
            size: Number(view.getBigUint64(at + 32, true)),
        };
    });
}

const hex = (number) => (number >>> 0).toString(16).padStart(8, '0');

/* `moduleBytes` is golden.wasm, `flash` what golden_flash wrote; both are ArrayBuffers or views. */
export async function drawGoldens(moduleBytes, flash) {
    const none = () => -1;
    const {instance} = await WebAssembly.instantiate(moduleBytes, {flash: {start: none, poll: none}});
    const x = instance.exports, lines = [];
    const text = (at) => {
        const bytes = new Uint8Array(x.memory.buffer, at, 64);
        return String.fromCharCode(...bytes.subarray(0, bytes.indexOf(0)));
    };
    placesOf(flash).forEach((place, n) => {
        if (place.size > x.image_bytes_max()) {
            throw new Error(`the image of ${place.name} is too large: ${place.size} bytes`);
        }
        new Uint8Array(x.memory.buffer, x.image(), place.size).set(new Uint8Array(flash, place.offset, place.size));
        lines.push(`image-${place.name} ${hex(x.image_checksum(place.size))}`);
        for (let i = 0; i < x.count(); i++) {
            if (x.place(i) !== n) {
                continue;
            }
            const status = x.fly(i, place.size, place.latitude, place.longitude);
            if (status !== 0) {
                throw new Error(`${text(x.name(i))}: the unit does not start: ${status}`);
            }
            lines.push(`${text(x.name(i))} ${hex(x.radar_checksum())} ${hex(x.glass_checksum())}`);
        }
    });
    return lines;
}
