/* Live targets that this page tells: where they are, and the way that they were given. A route is known
 * to the page alone; the displays hear where a target is and how it moves. */
import {ahead, between} from './geo.mjs';

const STEP_MOST_S = 5; // a jump of the exercise's clock moves no target

export class Target {
    /* `of`: number, kind, latitude, longitude, and what else targetFrames takes. */
    constructor(of) {
        Object.assign(this, {speedMs: 0, courseDeg: 0, heightM: null, rcsDbsm: null, signature: 0, route: [],
            isLoop: false}, of);
        this.route = [...this.route];
        this.aim();
    }

    /* Point to the next waypoint, if there is one. */
    aim() {
        if (this.route.length > 0) {
            this.courseDeg = between(this, this.route[0]).bearingDeg;
        }
    }

    /* Move on. True where the motion changed: at a corner, or at the end of the route. */
    advance(seconds) {
        let wayM = this.speedMs * Math.min(Math.max(seconds, 0), STEP_MOST_S), hasTurned = false;
        for (let legs = 0; this.route.length > 0 && legs < 64 && wayM > 0; legs++) {
            const {distanceM} = between(this, this.route[0]);
            if (wayM < distanceM) {
                break;
            }
            wayM -= distanceM;
            this.reach();
            hasTurned = true;
        }
        Object.assign(this, ahead(this, this.courseDeg, this.speedMs > 0 ? wayM : 0));
        this.aim();
        return hasTurned;
    }

    reach() {
        const [reached, ...rest] = this.route;
        Object.assign(this, {latitude: reached.latitude, longitude: reached.longitude});
        this.route = this.isLoop ? [...rest, reached] : rest;
        if (this.route.length === 0) {
            this.speedMs = 0; // it stands at the end of its way
        }
        this.aim();
    }
}
