"""What the canvas of repeater and debrief shows, picture by picture."""

# CRC-32C of what the canvas shows, as the firmware has its pixels: blue, green, red, 0.
CANVAS_SUM = """
globalThis.sums ??= new Map(); // by number of the picture: its step and sum
globalThis.crcTable ??= Uint32Array.from({length: 256}, (_, n) => {
    for (let bit = 0; bit < 8; bit++) { n = n >>> 1 ^ (n & 1 ? 0x82f63b78 : 0); }
    return n;
});
globalThis.sumOf = () => {
    const canvas = document.getElementById('glass');
    const p = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let crc = ~0;
    for (let at = 0; at < p.length; at += 4) {
        crc = crc >>> 8 ^ crcTable[(crc ^ p[at + 2]) & 255];
        crc = crc >>> 8 ^ crcTable[(crc ^ p[at + 1]) & 255];
        crc = crc >>> 8 ^ crcTable[(crc ^ p[at]) & 255];
        crc = crc >>> 8 ^ crcTable[crc & 255];
    }
    return (~crc >>> 0).toString(16).padStart(8, '0');
};
"""


def follow(b, name):
    """Open the repeater of a display, and note each picture of its canvas in `sums`."""
    b.get(f"repeater.html?display={name}")
    b.until("globalThis.repeater?.player")
    b.run(
        CANVAS_SUM + "repeater.onPicture = ({picture, steps}) => sums.set(picture, {steps, sum: sumOf()});"
        "repeater.player.ask('every', {isEvery: true});")
