/* A flight by hand: an aircraft that does what it is told, over a round Earth, and the CANaerospace
 * frames that its navigation would send (docs/bus.md, profile canas17). */

const EARTH_M = 6371008.8, G = 9.80665, DEG = Math.PI / 180;
const FLOAT = 0x02, LONG = 0x03, NODE = 9;
const STEP_US = 12500;
export const LIMITS = {bankDeg: 60, climbMs: 40, speedMs: [60, 340], heightM: [50, 15000]};

function clamp(x, [low, high]) {
    return Math.min(Math.max(x, low), high);
}

/* Four bytes of a number, the highest first, as CANaerospace has them. */
function bytesOf(type, number) {
    const view = new DataView(new ArrayBuffer(4));
    if (type === FLOAT) {
        view.setFloat32(0, number);
    } else {
        view.setInt32(0, Math.round(number));
    }
    return [...new Uint8Array(view.buffer)];
}

export class Flight {
    /* Degrees, metres above the ellipsoid, metres a second. */
    constructor({latitude, longitude, headingDeg, heightM, speedMs}) {
        Object.assign(this, {latitude, longitude, headingDeg, heightM, speedMs});
        this.bankDeg = 0;  // asked for, to the right
        this.climbMs = 0;  // asked for
        this.count = 0;    // of what was sent
        this.nextUs = null;
    }

    turn(deltaDeg) {
        this.bankDeg = clamp(this.bankDeg + deltaDeg, [-LIMITS.bankDeg, LIMITS.bankDeg]);
    }

    climb(deltaMs) {
        this.climbMs = clamp(this.climbMs + deltaMs, [-LIMITS.climbMs, LIMITS.climbMs]);
    }

    faster(deltaMs) {
        this.speedMs = clamp(this.speedMs + deltaMs, LIMITS.speedMs);
    }

    level() {
        this.bankDeg = 0;
        this.climbMs = 0;
    }

    /* Turn rate of a level turn with this bank, degrees a second. */
    get turnDegS() {
        return G * Math.tan(this.bankDeg * DEG) / this.speedMs / DEG;
    }

    advance(seconds) {
        const before = this.headingDeg;
        this.headingDeg = (before + this.turnDegS * seconds + 360) % 360;
        const mean = before + this.turnDegS * seconds / 2, way = this.speedMs * seconds / EARTH_M / DEG;
        this.latitude = clamp(this.latitude + way * Math.cos(mean * DEG), [-89, 89]);
        this.longitude += way * Math.sin(mean * DEG) / Math.cos(this.latitude * DEG);
        this.longitude -= 360 * Math.round(this.longitude / 360);
        const height = clamp(this.heightM + this.climbMs * seconds, LIMITS.heightM);
        this.climbMs = height === this.heightM ? 0 : this.climbMs;
        this.heightM = height;
    }

    describe() {
        const degrees = (x, digits) => x.toFixed(digits);
        return `${degrees(this.latitude, 3)} ${degrees(this.longitude, 3)}, heading ${degrees(this.headingDeg, 0)}, bank `
            + `${degrees(this.bankDeg, 0)}, ${this.heightM.toFixed(0)} m, climbing ${this.climbMs.toFixed(0)} m/s, `
            + `${this.speedMs.toFixed(0)} m/s`;
    }

    /* [identifier, type, value] of what is sent now. Attitude each time, the rest each eighth. */
    values() {
        const heading = this.headingDeg * DEG, way = this.headingDeg;
        const attitude = [[311, FLOAT, 0], [312, FLOAT, this.bankDeg], [321, FLOAT, way],
            [303, FLOAT, 0], [305, FLOAT, this.turnDegS], [1133, FLOAT, way]];
        if (this.count % 8 !== 0) {
            return attitude;
        }
        return attitude.concat([[1036, LONG, this.latitude * 1e7], [1037, LONG, this.longitude * 1e7],
            [1038, FLOAT, this.heightM], [1039, FLOAT, this.speedMs], [1040, FLOAT, way],
            [314, FLOAT, this.climbMs], [1130, FLOAT, this.speedMs * Math.sin(heading)],
            [1131, FLOAT, this.speedMs * Math.cos(heading)], [1132, FLOAT, this.climbMs]]);
    }

    /* Fly up to now, and hand over the frames. */
    deliver(unit, nowUs) {
        this.nextUs ??= nowUs;
        for (; this.nextUs <= nowUs; this.nextUs += STEP_US) {
            for (const [id, type, value] of this.values()) {
                const code = (id >= 1000 && id !== 1133 ? this.count / 8 : this.count) & 255;
                unit.frame({id, isExtended: false, data: [NODE, type, 0, code, ...bytesOf(type, value)],
                    timeUs: this.nextUs});
            }
            this.count++;
            this.advance(STEP_US / 1e6);
        }
    }
}
