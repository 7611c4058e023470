/* Frames of the instructor, made and read as docs/bus.md has them (CANaerospace, profile canas17).
 *
 * A frame is that of web/bus.mjs: {id, isExtended, data, timeUs}. What is made here is {id, data}: the
 * identifier and the bytes. A fact is what a frame, or a whole set of them, says:
 *
 *     const reader = new Reader();
 *     for (const fact of reader.take(frame)) ...   // {what: 'target', number: 5, latitude: ...}
 *
 * Nothing is believed that the page would refuse: wrong types, lengths and ranges give no fact and are
 * counted. Angles are degrees, lengths metres, speeds metres a second, times microseconds. */

export const STATION_NODE = 31;
export const TYPE = {NODATA: 0, FLOAT: 2, LONG: 3, ULONG: 4, BLONG: 5, CHAR: 9, UCHAR: 10, SHORT2: 12, CHAR4: 15,
    UCHAR4: 16, UCHAR2: 19, UCHAR3: 27, DOUBLEH: 30, DOUBLEL: 31};
const SIZE_OF = {2: 4, 3: 4, 4: 4, 5: 4, 9: 1, 10: 1, 12: 4, 15: 4, 16: 4, 19: 2, 27: 3, 30: 4, 31: 4};

export const ID = {controlStep: 1530, key: 1531, switch: 1532, knob: 1533, slewRight: 1534, slewUp: 1535, sector: 1536,
    rangeScale: 1537, sectorWidth: 1538, gain: 1539, cursorLatitude: 1540, cursorLongitude: 1541,
    steerLatitude: 1542, steerLongitude: 1543, patchLatitude: 1544, patchLongitude: 1545, patchCell: 1546,
    rainLatitude: 1800, jammerLatitude: 1804, weatherClear: 1807, seaState: 1808, windDirection: 1809,
    liveLatitude: 1810, liveLongitude: 1811, liveHeight: 1812, liveVelocity: 1813, liveHeading: 1814, liveKind: 1815,
    liveRcs: 1816, liveRemove: 1817, liveClear: 1818, liveAcceleration: 1819,
    exerciseTime: 1820, exerciseRate: 1821, exerciseSeed: 1822, malfunction: 1825, malfunctionClear: 1826};

export const ALL = 255; // of weather and malfunctions cleared
export const TARGETS = 256, CIRCLES = 4, SPEED_MOST = 1000;
const PART = {height: 1, velocity: 2, heading: 4, rcs: 8, acceleration: 16};
const FPW = 2; // dead reckoning: straight on

/* Kinds of live targets, in the order of their numbers. */
export const KINDS = ['unknown', 'person', 'car', 'truck', 'tracked vehicle', 'train', 'light aircraft', 'fighter',
    'large aircraft', 'helicopter', 'missile', 'boat', 'ship of 200 t', 'ship of 2,000 t', 'ship of 20,000 t',
        'structure',
    'corner reflector', 'radar beacon'];

/* Malfunctions, in the order of their numbers: name, unit of the amount ('' has none), its range, and
 * what the page offers to begin with. */
export const MALFUNCTIONS = [['no transmitter', '', 0, 0, 0], ['weak transmitter', 'dB', 0, 60, 20],
    ['noisy receiver', 'dB', 0, 60, 20], ['stuck antenna', 'deg', -180, 180, 0],
        ['drifting antenna', 'deg', -180, 180, 5],
    ['lost sector, left edge', 'deg', -180, 180, -20], ['lost sector, right edge', 'deg', -180, 180, 0],
    ['frozen video', '', 0, 0, 0], ['tilt offset', 'deg', -30, 30, 3], ['dead key', 'key', 1, 28, 1]]
    .map(([name, unit, low, high, usual]) => ({name, unit, low, high, usual}));

/* Words of the state word's bits (1500), as the glass shows them. `test_station` compares. */
export const FLAG_WORDS = ['NAV', 'NAV FAIL', 'DB FAIL', 'TILE', 'BUS', 'FZ', 'OFF MAP', 'NO RAD', 'UNABLE', 'WX',
    'BLW TERR',
    'MAG HDG', 'EXC', 'SENDER', 'MALF', 'RESTART', 'UNSIGNED', 'POLE'];
export const MODES = ['GM', 'GMT', 'SEA', 'BCN'], FIELDS_OF_VIEW = ['NORM', 'EXP', 'DBS1', 'DBS2'];
export const PAGES = ['radar', 'CNTL', 'DCLT', 'BIT', 'test pattern'];
export const SWITCHES = ['', 'designate', 'drop', 'freeze', 'release'];

/* ---- making frames ---- */

/* The bytes of values of a type, the highest first. */
function bytesOf(type, values) {
    const view = new DataView(new ArrayBuffer(SIZE_OF[type]));
    if (type === TYPE.FLOAT) {
        view.setFloat32(0, values[0]);
    } else if (type === TYPE.LONG || type === TYPE.ULONG) {
        view.setInt32(0, Math.round(values[0]));
    } else if (type === TYPE.SHORT2) {
        values.forEach((v, i) => view.setInt16(2 * i, Math.round(v)));
    } else {
        values.forEach((v, i) => view.setUint8(i, v & 255));
    }
    return [...new Uint8Array(view.buffer)];
}

/* A frame without its node and message code, which whoever sends it puts in: see `linesOf`. */
export function frame(id, type, values, service = 0) {
    return {id, type, service, bytes: bytesOf(type, [].concat(values))};
}

const place = (id, latitude, longitude, service) => [frame(id, TYPE.LONG, latitude * 1e7, service),
    frame(id + 1, TYPE.LONG, longitude * 1e7, service)];

/* Lines of `candump -L` of frames that are one set: one node, one message code. */
export function linesOf(frames, node, code) {
    const hex = (byte) => byte.toString(16).toUpperCase().padStart(2, '0');
    return frames.map(({id, type, service, bytes}) => {
        const name = id.toString(16).toUpperCase().padStart(3, '0');
        return `(0.000000) page ${name}#${[node, type, service, code, ...bytes].map(hex).join('')}`;
    });
}

export function rainFrames(number, {latitude, longitude, radiusM, rateMmH}) {
    return [...place(ID.rainLatitude, latitude, longitude, number),
        frame(ID.rainLatitude + 2, TYPE.FLOAT, radiusM, number),
        frame(ID.rainLatitude + 3, TYPE.FLOAT, rateMmH, number)];
}

export function jammerFrames(number, {latitude, longitude, ratioDb}) {
    return [...place(ID.jammerLatitude, latitude, longitude, number),
        frame(ID.jammerLatitude + 2, TYPE.FLOAT, ratioDb, number)];
}

/* A live target. Left out or null: heightM (on the ground), rcsDbsm (of its kind). */
export function targetFrames(number, t) {
    const {heightM = null, rcsDbsm = null, speedMs = 0, courseDeg = 0, signature = 0} = t;
    const course = courseDeg * Math.PI / 180;
    const parts = PART.heading + (speedMs > 0 ? PART.velocity : 0) + (heightM === null ? 0 : PART.height)
        + (rcsDbsm === null ? 0 : PART.rcs);
    const set = [frame(ID.liveKind, TYPE.UCHAR4, [t.kind, FPW, signature, parts], number),
        ...place(ID.liveLatitude, t.latitude, t.longitude, number)];
    if (heightM !== null) {
        set.push(frame(ID.liveHeight, TYPE.FLOAT, heightM, number));
    }
    if (speedMs > 0) {
        set.push(frame(ID.liveVelocity, TYPE.SHORT2, [20 * speedMs * Math.sin(course), 20 * speedMs * Math.cos(course)],
            number));
    }
    set.push(frame(ID.liveHeading, TYPE.SHORT2, [signedDegrees(courseDeg) * 32768 / 180, 0], number));
    return rcsDbsm === null ? set : [...set, frame(ID.liveRcs, TYPE.FLOAT, rcsDbsm, number)];
}

/* The clock: the rate, then the time, which holds from now on. The seed where there is one. */
export function clockFrames({timeMs, rate, seed = null}) {
    const set = [frame(ID.exerciseRate, TYPE.FLOAT, rate), frame(ID.exerciseTime, TYPE.LONG, Math.max(timeMs, 0))];
    return seed === null ? set : [frame(ID.exerciseSeed, TYPE.LONG, seed), ...set];
}

export const seaFrames = (state) => [frame(ID.seaState, TYPE.UCHAR, state)];
export const windFrames = (fromDeg) => [frame(ID.windDirection, TYPE.FLOAT, fromDeg)];
export const malfunctionFrames = (kind, amount) => [frame(ID.malfunction, TYPE.FLOAT, amount, kind)];
export const clearMalfunctionFrames = (kind) => [frame(ID.malfunctionClear, TYPE.UCHAR, kind)];
export const clearWeatherFrames = (bits) => [frame(ID.weatherClear, TYPE.UCHAR, bits)];
export const removeTargetFrames = (number) => [frame(ID.liveRemove, TYPE.UCHAR, 0, number)];
export const clearTargetsFrames = () => [frame(ID.liveClear, TYPE.UCHAR, 0)];

/* Controls of the displays that obey. */
export const controlFrames = {
    key: (isDown, number) => [frame(ID.key, TYPE.UCHAR, number, isDown ? 1 : 0)],
    switch: (act) => [frame(ID.switch, TYPE.UCHAR, act)],
    knob: (thousandths) => [frame(ID.knob, TYPE.LONG, thousandths)],
    slew: (right, up) => [frame(ID.slewRight, TYPE.LONG, right), frame(ID.slewUp, TYPE.LONG, up)],
    sector: (mode, field) => [frame(ID.sector, TYPE.UCHAR2, [mode, field])],
    rangeScale: (nm) => [frame(ID.rangeScale, TYPE.LONG, nm)],
    sectorWidth: (number) => [frame(ID.sectorWidth, TYPE.UCHAR, number)],
    gain: (db) => [frame(ID.gain, TYPE.CHAR, db)],
    cursor: (latitude, longitude) => place(ID.cursorLatitude, latitude, longitude, 0),
    steer: (latitude, longitude) => place(ID.steerLatitude, latitude, longitude, 0),
    steerOff: () => place(ID.steerLatitude, 0, 0, 1),
    patch: (latitude, longitude, cellM) => [...place(ID.patchLatitude, latitude, longitude, 4),
        frame(ID.patchCell, TYPE.LONG, 1000 * cellM, 4)]
};

/* ---- reading frames ---- */

export function signedDegrees(degrees) {
    return degrees - 360 * Math.round(degrees / 360);
}

/* The numbers of a frame's data, or null where type and length are not those of the table. */
function numbersOf(data) {
    const type = data[1], bytes = data.slice(4);
    if (SIZE_OF[type] === undefined || bytes.length !== SIZE_OF[type]) {
        return null;
    }
    const view = new DataView(Uint8Array.from(bytes).buffer);
    switch (type) {
    case TYPE.FLOAT: return Number.isFinite(view.getFloat32(0)) ? [view.getFloat32(0)] : null;
    case TYPE.LONG: return [view.getInt32(0)];
    case TYPE.SHORT2: return [view.getInt16(0), view.getInt16(2)];
    case TYPE.ULONG: case TYPE.BLONG: case TYPE.DOUBLEH: case TYPE.DOUBLEL: return [view.getUint32(0)];
    case TYPE.CHAR: return [view.getInt8(0)];
    default: return bytes;
    }
}

const INTO = (low, high) => (x) => x >= low && x <= high;
const LATITUDE = INTO(-90, 90), LONGITUDE = INTO(-180, 180), HEIGHT = INTO(-1000, 30000), TURN = INTO(-360, 360);

/* What own aircraft's items are: identifier to [field, preference, believed range]. */
const NAVIGATION = new Map([[1036, ['latitude', 0, LATITUDE]], [1037, ['longitude', 0, LONGITUDE]],
    [1049, ['latitude', 1, LATITUDE]], [1050, ['longitude', 1, LONGITUDE]], [1059, ['latitude', 2, LATITUDE]],
    [1060, ['longitude', 2, LONGITUDE]], [1038, ['heightM', 0, HEIGHT]], [332, ['heightM', 1, HEIGHT]],
    [320, ['heightM', 2, HEIGHT]], [1133, ['headingDeg', 0, TURN]], [321, ['headingDeg', 1, TURN]],
    [1040, ['trackDeg', 0, TURN]], [1053, ['trackDeg', 1, TURN]], [1039, ['speedMs', 0, INTO(0, 1500)]],
    [1052, ['speedMs', 1, INTO(0, 1500)]]]);
const HALVES_APART_US = 100000;

/* Sets: the identifier of each member to its name, how to read it, and what makes the set whole. */
const degrees7 = (type, [x]) => type === TYPE.LONG ? x / 1e7 : type === TYPE.FLOAT ? x : NaN;
const float = (type, [x]) => type === TYPE.FLOAT ? x : NaN;
const pair = (unit) => (type, [a, b]) => type === TYPE.SHORT2 ? [a * unit, b * unit] : NaN;
const SETS = [
    {what: 'rain', withinUs: 1e6, most: CIRCLES, needs: () => [1800, 1801, 1802, 1803], members: new Map([
        [1800, ['latitude', degrees7, LATITUDE]], [1801, ['longitude', degrees7, LONGITUDE]],
        [1802, ['radiusM', float, INTO(100, 100000)]], [1803, ['rateMmH', float, INTO(1, 150)]]])},
    {what: 'jammer', withinUs: 1e6, most: CIRCLES, needs: () => [1804, 1805, 1806], members: new Map([
        [1804, ['latitude', degrees7, LATITUDE]], [1805, ['longitude', degrees7, LONGITUDE]],
        [1806, ['ratioDb', float, INTO(-20, 80)]]])},
    {what: 'target', withinUs: 200000, most: TARGETS, needs: needsOfTarget, members: new Map([
        [1810, ['latitude', degrees7, LATITUDE]], [1811, ['longitude', degrees7, LONGITUDE]],
        [1812, ['heightM', float, INTO(-1000, 16000)]], [1813, ['velocityMs', pair(0.05), () => true]],
        [1814, ['heading', (type, [a, b]) => type === TYPE.SHORT2 ? [a * 180 / 32768, b * 0.01] : NaN, () => true]],
        [1815, ['description', (type, bytes) => type === TYPE.UCHAR4 ? bytes : NaN, (b) => b[1] <= 9 && b[3] <= 31]],
        [1816, ['rcsDbsm', float, INTO(-40, 60)]], [1819, ['accelerationMs2', pair(0.01), () => true]]])}
];
const SET_OF = new Map(SETS.flatMap((set) => [...set.members.keys()].map((id) => [id, set])));

function needsOfTarget({description}) {
    const byPart = [[PART.height, 1812], [PART.velocity, 1813], [PART.heading, 1814], [PART.rcs, 1816],
        [PART.acceleration, 1819]];
    return !description ? [1810, 1811, 1815]
        : [1810, 1811, 1815].concat(byPart.filter(([part]) => description[3] & part).map(([, id]) => id));
}

/* Frames that say something by themselves: identifier to [type, fact]. The fact may be null: refused. */
const count = (what, low, high, name = 'value') => ([x]) => x >= low && x <= high ? {what, [name]: x} : null;
const SINGLES = new Map([
    [1807, [TYPE.UCHAR, ([bits]) => ({what: 'weather-clear', bits})]],
    [1808, [TYPE.UCHAR, count('sea', 0, 8)]],
    [1809, [TYPE.FLOAT, count('wind', -180, 360)]],
    [1817, [TYPE.UCHAR, (x, service) => ({what: 'target-remove', number: service})]],
    [1818, [TYPE.UCHAR, () => ({what: 'target-clear'})]],
    [1820, [TYPE.LONG, count('exercise-time', 0, 2147483647, 'timeMs')]],
    [1821, [TYPE.FLOAT, count('exercise-rate', 0, 16, 'rate')]],
    [1822, [TYPE.LONG, count('exercise-seed', 0, 2147483647, 'seed')]],
    [1825, [TYPE.FLOAT, ([amount], kind) => {
        const of = MALFUNCTIONS[kind];
        return of && (of.unit === '' || (amount >= of.low && amount <= of.high)) ? {what: 'malfunction', kind, amount}
            : null;
    }]],
    [1826, [TYPE.UCHAR, ([kind]) => kind < MALFUNCTIONS.length || kind === ALL ? {what: 'malfunction-clear', kind}
        : null]],
    [1500, [TYPE.BLONG, ([flags]) => ({what: 'display-state', flags})]],
    [1519, [TYPE.UCHAR4, ([kind, mode, field, page]) => ({what: 'display-picture', kind, mode, field, page})]],
    [1520, [TYPE.LONG, ([nm]) => ({what: 'display-range', nm})]],
    [1521, [TYPE.UCHAR2, ([halfSectorDeg, switches]) => ({what: 'display-settings', halfSectorDeg, switches})]],
    ...[['cursor', 1510], ['place', 1516]].flatMap(([what, id]) => ['latitude', 'longitude'].map((name, i) =>
        [id + i, [TYPE.LONG, ([x]) => ({what: `display-${what}`, [name]: x / 1e7})]])),
    ...Array.from({length: 20}, (_, i) => [1530 + i, [null, (values, service, type) =>
        ({what: 'control', item: 1530 + i, values, service, type})]])
]);

/* What a fact's frame was, for whoever asks whether it is their own: identifier and data. */
const keyOf = ({id, data}) => `${id}#${data.join(',')}`;

export class Reader {
    constructor() {
        this.sets = new Map();   // by what, node and number
        this.halves = new Map(); // of DOUBLEs, by identifier
        this.refused = 0;
    }

    /* The facts of a frame: none, or one. */
    take(frame) {
        const {id, isExtended, data} = frame, channel = isExtended ? id >>> 16 : 0, item = isExtended ? id & 65535 : id;
        if (data.length < 4 || data[0] === 0 || channel > 3 || data[1] === TYPE.NODATA) {
            return [];
        }
        const isKnown = NAVIGATION.has(item) || (channel === 0 && (SET_OF.has(item) || SINGLES.has(item)));
        const values = isKnown ? numbersOf(data) : null;
        if (!isKnown || !values) {
            this.refused += isKnown ? 1 : 0;
            return [];
        }
        const about = {node: data[0], code: data[3], timeUs: frame.timeUs, keys: [keyOf(frame)]};
        const fact = NAVIGATION.has(item) ? this.navigation(item, channel, data, values, about)
            : SET_OF.has(item) ? this.member(item, data, values, about)
            : this.single(item, data, values);
        if (fact === null) {
            this.refused++;
        }
        return fact ? [{...about, ...fact}] : [];
    }

    single(item, [, type, service], values) {
        const [wanted, factOf] = SINGLES.get(item);
        return wanted !== null && wanted !== type ? null : factOf(values, service, type);
    }

    navigation(item, channel, data, values, about) {
        const [field, preference, isBelieved] = NAVIGATION.get(item), type = data[1];
        const value = type === TYPE.DOUBLEH || type === TYPE.DOUBLEL
            ? this.joinHalves(item + 65536 * channel, data, values[0], about)
            : type === TYPE.SHORT2 ? values[0] * values[1] / 32767
            : type === TYPE.LONG && isBelieved(values[0] / 1e7) ? values[0] / 1e7
            : type === TYPE.FLOAT ? values[0] : NaN;
        if (value === undefined) {
            return undefined;
        }
        return isBelieved(value) ? {what: 'own', field, value, preference: 4 * preference + channel} : null;
    }

    /* The double of two halves whose codes are one apart, whichever comes first; undefined before. */
    joinHalves(key, [node, type, , code], word, {timeUs}) {
        const before = this.halves.get(key), half = {node, type, code, word, timeUs};
        const isPair = before && before.type !== type && before.node === node && ((code - before.code) & 255) === 1
            && timeUs - before.timeUs <= HALVES_APART_US;
        if (!isPair) {
            this.halves.set(key, half);
            return undefined;
        }
        this.halves.delete(key);
        const view = new DataView(new ArrayBuffer(8));
        [before, half].forEach((h) => view.setUint32(h.type === TYPE.DOUBLEH ? 0 : 4, h.word));
        return view.getFloat64(0);
    }

    /* A member of a set: the fact when it makes the set whole. */
    member(item, data, values, about) {
        const kind = SET_OF.get(item), [node, type, number, code] = data;
        const [name, read, isBelieved] = kind.members.get(item), value = read(type, values);
        if (number >= kind.most || Number.isNaN(value) || !isBelieved(value)) {
            return null;
        }
        const key = `${kind.what} ${node} ${number}`, held = this.sets.get(key);
        const isSame = held && held.code === code && !(item in held.values)
            && about.timeUs - held.timeUs <= kind.withinUs;
        const set = isSame ? held : {code, timeUs: about.timeUs, values: {}, keys: [], named: {}};
        set.values[item] = value;
        set.named[name] = value;
        set.keys.push(...about.keys);
        this.sets.set(key, set);
        const needs = kind.needs(set.named);
        if (!needs.every((id) => id in set.values)) {
            return undefined;
        }
        this.sets.delete(key);
        return this.whole(kind, number, set, needs);
    }

    whole(kind, number, {named, timeUs, keys, values}, needs) {
        if (Object.keys(values).length !== needs.length) {
            return null; // a frame that the set does not name
        }
        const fact = {what: kind.what, number, timeUs, keys};
        if (kind.what !== 'target') {
            return {...fact, ...named};
        }
        const {description: [k, reckoning, signature, parts], velocityMs: [east, north] = [0, 0], latitude,
            longitude} = named;
        const speedMs = Math.hypot(east, north), along = speedMs > 0 ? Math.atan2(east, north) * 180 / Math.PI : 0;
        const [courseDeg, turnDegS] = named.heading ?? [along, 0];
        return speedMs > SPEED_MOST || Math.abs(turnDegS) > 60 ? null
            : {...fact, kind: k < KINDS.length ? k : 0, reckoning,
            signature, parts, latitude, longitude, eastMs: east, northMs: north, speedMs, headingDeg: courseDeg,
            courseDeg: speedMs > 0 ? along : courseDeg, turnDegS, heightM: named.heightM ?? null,
                rcsDbsm: named.rcsDbsm ?? null};
    }
}
