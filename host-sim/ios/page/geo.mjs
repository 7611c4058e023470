/* Places on a round Earth, in degrees, and their words. */

const EARTH_M = 6371008.8, DEG = Math.PI / 180;
export const NAUTICAL_MILE_M = 1852;

export function wrapLongitude(longitude) {
    return longitude - 360 * Math.round(longitude / 360);
}

/* The place so many metres away, in a direction from true north. */
export function ahead({latitude, longitude}, bearingDeg, distanceM) {
    const a = latitude * DEG, way = distanceM / EARTH_M, turn = bearingDeg * DEG;
    const sine = Math.sin(a) * Math.cos(way) + Math.cos(a) * Math.sin(way) * Math.cos(turn);
    const east = Math.atan2(Math.sin(turn) * Math.sin(way) * Math.cos(a), Math.cos(way) - Math.sin(a) * sine);
    return {latitude: Math.asin(Math.min(Math.max(sine, -1), 1)) / DEG,
        longitude: wrapLongitude(longitude + east / DEG)};
}

/* Distance and first direction (0..360) from one place to another. */
export function between(from, to) {
    const a = from.latitude * DEG, b = to.latitude * DEG, east = (to.longitude - from.longitude) * DEG;
    const chord = Math.sin((b - a) / 2) ** 2 + Math.cos(a) * Math.cos(b) * Math.sin(east / 2) ** 2;
    const turn = Math.atan2(Math.sin(east) * Math.cos(b),
        Math.cos(a) * Math.sin(b) - Math.sin(a) * Math.cos(b) * Math.cos(east));
    return {distanceM: 2 * EARTH_M * Math.asin(Math.min(Math.sqrt(chord), 1)), bearingDeg: (turn / DEG + 360) % 360};
}

export function placeWords({latitude, longitude}) {
    const half = (x, letters) => `${Math.abs(x).toFixed(4)} ${letters[x < 0 ? 1 : 0]}`;
    return `${half(latitude, 'NS')} ${half(longitude, 'EW')}`;
}

/* Hours, minutes and seconds of milliseconds: 1:02:03. */
export function clockWords(ms) {
    const s = Math.floor(ms / 1000), two = (x) => String(x).padStart(2, '0');
    return `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
}

/* Milliseconds of h:mm:ss, mm:ss or seconds; null of anything else, or beyond what 1820 can say. */
export function clockOf(words) {
    const parts = /^\s*(?:(?:(\d{1,3}):)?(\d{1,4}):)?(\d{1,7}(?:\.\d{1,3})?)\s*$/.exec(words);
    const ms = parts ? Math.round(1000 * (3600 * Number(parts[1] ?? 0) + 60 * Number(parts[2] ?? 0) + Number(parts[3])))
        : -1;
    return ms >= 0 && ms <= 2147483647 ? ms : null;
}
