/* What is drawn upon the map: own aircraft and its track, targets and their ways, weather, and where the
 * displays look. Nothing is told by colour alone: each thing has a shape and words of its own. */
import {MODES} from './frames.mjs';
import {between, NAUTICAL_MILE_M} from './geo.mjs';
import {OWN_STALE_US, STALE_US} from './world.mjs';

const COLOUR = {own: '#fff', stale: '#ffb000', target: '#ff6a5e', chosen: '#ffe14d', rain: '#6cc5ff', jammer: '#e08bff',
    display: '#7dff9a'};
const VECTOR_S = 30; // how far ahead the line of a target's speed reaches

/* A symbol of lines around a pixel, turned by degrees from north. */
function symbol(map, [x, y], degrees, strokes, colour) {
    const s = Math.sin(degrees * Math.PI / 180), c = Math.cos(degrees * Math.PI / 180);
    [['#000', 5], [colour, 2.5]].forEach(([ink, wide]) => map.stroke(ink, wide, (pen) => strokes.forEach((points) =>
        points.forEach(([right, up], i) => {
            const at = [x + right * c + up * s, y + right * s - up * c];
            pen[i === 0 ? 'moveTo' : 'lineTo'](...at);
        }))));
}

const AIRCRAFT = [[[0, 14], [0, -12]], [[-13, 1], [13, 1]], [[-5, -11], [5, -11]]];
const SHAPES = {ship: [[[0, 9], [5, 2], [5, -8], [-5, -8], [-5, 2], [0, 9]]],
    air: [[[0, 9], [0, -7]], [[-8, 0], [8, 0]]],
    ground: [[[-6, 6], [6, 6], [6, -6], [-6, -6], [-6, 6]]], still: [[[0, 8], [7, -6], [-7, -6], [0, 8]]]};
const shapeOf = (kind) => kind >= 6 && kind <= 10 ? SHAPES.air : kind >= 11 && kind <= 14 ? SHAPES.ship : kind >= 15
    ? SHAPES.still : SHAPES.ground;

export function ownLayer(world) {
    return (map) => {
        const own = world.ownAircraft();
        map.line(world.track, '#000', 4);
        map.line(world.track, COLOUR.own, 1.5);
        if (!own) {
            return;
        }
        const isStale = own.ageUs > OWN_STALE_US, colour = isStale ? COLOUR.stale : COLOUR.own,
            [x, y] = map.toPixel(own);
        symbol(map, [x, y], own.headingDeg ?? 0, AIRCRAFT, colour);
        map.words(isStale ? `STALE ${(own.ageUs / 1e6).toFixed(0)} s` : 'OWN', x + 16, y - 10, colour);
    };
}

/* Where the displays look: the sector of each, its cursor and its patch. */
export function displayLayer(world) {
    return (map) => world.displays.forEach((display) => {
        const own = world.ownAircraft(), {range, settings, picture, cursor, place, node} = display;
        const isFresh = (thing) => thing && world.nowUs - thing.timeUs < STALE_US;
        if (own?.headingDeg != null && isFresh(range) && isFresh(settings) && picture?.kind === 0) {
            const far = range.nm * NAUTICAL_MILE_M, half = settings.halfSectorDeg;
            map.stroke(COLOUR.display, 1, (pen) => {
                pen.moveTo(...map.toPixel(own));
                for (let turn = -half; turn <= half; turn += 3) {
                    pen.lineTo(...map.offset(own, own.headingDeg + turn, far));
                }
                pen.closePath();
            }, [6, 4]);
        }
        [[cursor, 'cursor'], [place, 'patch']].filter(([thing]) => isFresh(thing) && 'latitude' in thing
            && 'longitude' in thing)
            .forEach(([thing, name]) => {
                const at = map.toPixel(thing);
                symbol(map, at, 0, [[[-9, 0], [9, 0]], [[0, -9], [0, 9]]], COLOUR.display);
                map.words(`${name} ${node}${picture && name === 'cursor' ? ` ${MODES[picture.mode] ?? ''}` : ''}`,
                    at[0] + 11, at[1] + 14, COLOUR.display);
            });
    });
}

/* Rain and jammers; one that is dragged stands where the hand is, with an edge of dots. */
export function weatherLayer(world, grabbedOf) {
    return (map) => {
        for (const [what, colour] of [['rain', COLOUR.rain], ['jammer', COLOUR.jammer]]) {
            world[what].forEach((circle, number) => {
                const grabbed = grabbedOf(what, number), place = grabbed ?? circle,
                    dash = grabbed || world.isStale(circle) ? [3, 4] : [];
                const [x, y] = map.toPixel(place);
                if (what === 'rain') {
                    map.circle(place, circle.radiusM / map.metresPerPixel(place.latitude), colour, 2,
                        'rgba(80,160,255,0.18)', dash);
                    map.words(`rain ${number} ${circle.rateMmH.toFixed(0)} mm/h`, x - 30, y + 4, colour);
                } else {
                    symbol(map, [x, y], 0, [[[-9, -9], [9, 9]], [[-9, 9], [9, -9]], [[0, 12], [0, -12]]], colour);
                    map.words(`jammer ${number} ${circle.ratioDb.toFixed(0)} dB`, x + 14, y + 4, colour);
                }
            });
        }
    };
}

export function targetLayer(world, {chosen, grabbedOf, routeOf}) {
    return (map) => world.targets.forEach((target, number) => {
        const grabbed = grabbedOf('target', number), place = grabbed ?? world.reckoned(target), at = map.toPixel(place);
        const colour = chosen() === number ? COLOUR.chosen : COLOUR.target, route = routeOf(number);
        if (route.length > 0) {
            map.line([place, ...route], colour, 1.5, [6, 5]);
            route.forEach((waypoint, i) => {
                map.circle(waypoint, 4, colour, 2);
                const [x, y] = map.toPixel(waypoint);
                map.words(String(i + 1), x + 6, y - 6, colour);
            });
        }
        if (target.speedMs > 0) {
            map.stroke(colour, 2, (pen) => {
                pen.moveTo(...at);
                pen.lineTo(...map.offset(place, target.courseDeg, VECTOR_S * target.speedMs));
            });
        }
        symbol(map, at, target.headingDeg, shapeOf(target.kind), colour);
        if (chosen() === number) {
            map.circle(place, 15, colour, 2);
        }
        map.words(`${number}${world.isStale(target) ? ' ?' : ''}`, at[0] + 11, at[1] - 9, colour);
    });
}

/* What lies within so many metres of a place: a target first, then jammers and the middle of rain. */
export function handleAt(world, place, nearM) {
    let best = null;
    const offer = (what, number, at) => {
        const {distanceM} = between(place, at);
        if (distanceM < nearM && (!best || distanceM < best.distanceM)) {
            best = {what, number, distanceM};
        }
    };
    world.targets.forEach((target, number) => offer('target', number, world.reckoned(target)));
    if (!best) {
        ['jammer', 'rain'].forEach((what) => world[what].forEach((circle, number) => offer(what, number, circle)));
    }
    return best;
}
