/* The moving map: tiles of the server on a canvas (Web Mercator), and what the bus says upon them. Mouse,
 * touch and keyboard pan and zoom it; what a click means the page says (`on.act`, `on.grab`). */
import {NAUTICAL_MILE_M, ahead} from './geo.mjs';

const TILE = 256, TILES_KEPT = 400, ZOOM_LEAST = 3, ZOOM_BEYOND = 4;
const TAP_PX = 6, NEAR_PX = {mouse: 14, pen: 20, touch: 26};
const DEG = Math.PI / 180, EQUATOR_M = 40075016.686;
const ARROWS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};

/* Places to the unit square, and back. */
export function squareOf({latitude, longitude}) {
    const sine = Math.sin(Math.min(Math.max(latitude, -85), 85) * DEG);
    return [longitude / 360 + 0.5, 0.5 - Math.log((1 + sine) / (1 - sine)) / (4 * Math.PI)];
}

export function placeOf([x, y]) {
    return {latitude: Math.atan(Math.sinh(Math.PI * (1 - 2 * y))) / DEG, longitude: 360 * (x - 0.5)};
}

export class MovingMap {
    /* `bounds`: that of map.json. `on`: {act(place), grab(place, nearM), drop(handle, place), changed()}. */
    constructor(canvas, bounds, on) {
        Object.assign(this, {canvas, bounds, on, context: canvas.getContext('2d', {alpha: false}), tiles: new Map(),
            pointers: new Map(),
            isFollowing: true, isKeyboard: false, grabbed: null});
        this.wholeMap();
        this.listen();
    }

    /* ---- view ---- */

    wholeMap() {
        const {west, south, east, north} = this.bounds;
        const [left, top] = squareOf({latitude: north, longitude: west}),
            [right, bottom] = squareOf({latitude: south, longitude: east});
        this.center = [(left + right) / 2, (top + bottom) / 2];
        const {clientWidth, clientHeight} = this.canvas;
        this.zoom = this.clampZoom(Math.log2(Math.min(clientWidth / (right - left),
            clientHeight / (bottom - top)) / TILE));
        this.isFollowing = false;
        this.on.changed?.();
    }

    clampZoom(zoom) {
        return Math.min(Math.max(Number.isFinite(zoom) ? zoom : 9, ZOOM_LEAST), this.bounds.zoom_max + ZOOM_BEYOND);
    }

    get pixels() {
        return TILE * 2 ** this.zoom; // of the whole square
    }

    get centerPlace() {
        return placeOf(this.center);
    }

    metresPerPixel(latitude = this.centerPlace.latitude) {
        return EQUATOR_M * Math.cos(latitude * DEG) / this.pixels;
    }

    toPixel(place) {
        const [x, y] = squareOf(place);
        return [(x - this.center[0]) * this.pixels + this.canvas.clientWidth / 2,
            (y - this.center[1]) * this.pixels + this.canvas.clientHeight / 2];
    }

    toPlace(x, y) {
        return placeOf([this.center[0] + (x - this.canvas.clientWidth / 2) / this.pixels,
            this.center[1] + (y - this.canvas.clientHeight / 2) / this.pixels]);
    }

    goTo(place) {
        this.center = squareOf(place);
        this.on.changed?.();
    }

    pan(dx, dy) {
        this.center = [this.center[0] - dx / this.pixels, Math.min(Math.max(this.center[1] - dy / this.pixels, 0), 1)];
        this.isFollowing = false;
        this.on.changed?.();
    }

    /* Zoom about a pixel, which keeps its place. */
    zoomBy(steps, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
        const fixed = squareOf(this.toPlace(x, y));
        this.zoom = this.clampZoom(this.zoom + steps);
        if (!this.isFollowing) {
            this.center = [fixed[0] - (x - this.canvas.clientWidth / 2) / this.pixels,
                fixed[1] - (y - this.canvas.clientHeight / 2) / this.pixels];
        }
        this.on.changed?.();
    }

    /* ---- hands ---- */

    listen() {
        const {canvas} = this;
        canvas.addEventListener('pointerdown', (event) => this.pointerDown(event));
        canvas.addEventListener('pointermove', (event) => this.pointerMove(event));
        ['pointerup', 'pointercancel'].forEach((name) => canvas.addEventListener(name,
            (event) => this.pointerUp(event)));
        canvas.addEventListener('wheel', (event) => {
            event.preventDefault();
            this.zoomBy(-event.deltaY / 400, event.offsetX, event.offsetY);
        }, {passive: false});
        canvas.addEventListener('keydown', (event) => this.key(event));
        canvas.addEventListener('blur', () => this.on.changed?.());
        canvas.addEventListener('focus', () => this.on.changed?.());
        new ResizeObserver(() => this.on.changed?.()).observe(canvas);
    }

    pointerDown(event) {
        if (event.button !== 0) {
            return;
        }
        this.canvas.setPointerCapture(event.pointerId);
        this.isKeyboard = false;
        const at = [event.offsetX, event.offsetY];
        this.pointers.set(event.pointerId, {at, first: at, hasMoved: false});
        const nearM = (NEAR_PX[event.pointerType] ?? NEAR_PX.mouse) * this.metresPerPixel();
        this.grabbed = this.pointers.size === 1 ? this.on.grab(this.toPlace(...at), nearM) : null;
    }

    pointerMove(event) {
        const pointer = this.pointers.get(event.pointerId);
        if (!pointer) {
            return;
        }
        const at = [event.offsetX, event.offsetY], [dx, dy] = [at[0] - pointer.at[0], at[1] - pointer.at[1]];
        pointer.hasMoved ||= Math.hypot(at[0] - pointer.first[0], at[1] - pointer.first[1]) > TAP_PX;
        if (this.pointers.size === 2) {
            this.pinch(pointer, at);
        } else if (pointer.hasMoved && this.grabbed) {
            this.grabbed.place = this.toPlace(...at);
            this.on.changed?.();
        } else if (pointer.hasMoved) {
            this.pan(dx, dy);
        }
        if (pointer.hasMoved || this.pointers.size === 2) {
            pointer.at = at;
        }
    }

    /* Two fingers: the distance between them zooms, their middle pans. */
    pinch(moved, at) {
        const other = [...this.pointers.values()].find((pointer) => pointer !== moved);
        const apart = (p) => Math.max(Math.hypot(p[0] - other.at[0], p[1] - other.at[1]), 1);
        moved.hasMoved = other.hasMoved = true;
        this.grabbed = null;
        this.pan((at[0] - moved.at[0]) / 2, (at[1] - moved.at[1]) / 2);
        this.zoomBy(Math.log2(apart(at) / apart(moved.at)), (at[0] + other.at[0]) / 2, (at[1] + other.at[1]) / 2);
    }

    pointerUp(event) {
        const pointer = this.pointers.get(event.pointerId);
        this.pointers.delete(event.pointerId);
        if (!pointer || event.type === 'pointercancel') {
            this.grabbed = null;
            return;
        }
        const place = this.toPlace(event.offsetX, event.offsetY), handle = this.grabbed;
        this.grabbed = null;
        if (!pointer.hasMoved) {
            this.on.act(place, handle);
        } else if (handle) {
            this.on.drop(handle, place);
        }
        this.on.changed?.();
    }

    key(event) {
        const arrow = ARROWS[event.key], step = event.shiftKey ? 4 : 48;
        if (arrow) {
            this.pan(-arrow[0] * step, -arrow[1] * step);
        } else if (event.key === '+' || event.key === '=') {
            this.zoomBy(0.5);
        } else if (event.key === '-') {
            this.zoomBy(-0.5);
        } else if (event.key === 'Enter' || event.key === ' ') {
            this.on.act(this.centerPlace, this.on.grab(this.centerPlace, NEAR_PX.touch * this.metresPerPixel()));
        } else if (!this.on.key?.(event.key)) {
            return;
        }
        this.isKeyboard = true;
        event.preventDefault();
        this.on.changed?.();
    }

    /* ---- drawing ---- */

    tile(z, x, y) {
        const url = `map/${z}/${x}/${y}.png`;
        let tile = this.tiles.get(url);
        if (!tile) {
            tile = {image: new Image(), isThere: false};
            tile.image.onload = () => {
                tile.isThere = true;
                this.on.changed?.();
            };
            tile.image.src = url;
            if (this.tiles.size >= TILES_KEPT) {
                this.tiles.delete(this.tiles.keys().next().value);
            }
        } else {
            this.tiles.delete(url); // the last used stands last
        }
        this.tiles.set(url, tile);
        return tile;
    }

    drawTiles() {
        const {context: c, canvas: {clientWidth: width, clientHeight: height}} = this;
        c.fillStyle = '#181c20';
        c.fillRect(0, 0, width, height);
        const z = Math.min(Math.max(Math.round(this.zoom), 0), this.bounds.zoom_max), count = 2 ** z,
            side = this.pixels / count;
        const {west, south, east, north} = this.bounds;
        const [left, top] = squareOf({latitude: north, longitude: west}),
            [right, bottom] = squareOf({latitude: south, longitude: east});
        const [x0, y0] = squareOf(this.toPlace(0, 0)), [x1, y1] = squareOf(this.toPlace(width, height));
        const from = (a, b) => Math.max(Math.floor(Math.max(a, b) * count), 0),
            to = (a, b) => Math.min(Math.floor(Math.min(a, b) * count), count - 1);
        c.imageSmoothingEnabled = side < 1.5 * TILE;
        for (let y = from(top, y0); y <= to(bottom, y1); y++) {
            for (let x = from(left, x0); x <= to(right, x1); x++) {
                const tile = this.tile(z, x, y);
                if (tile.isThere) {
                    const px = (x / count - this.center[0]) * this.pixels + width / 2,
                        py = (y / count - this.center[1]) * this.pixels + height / 2;
                    c.drawImage(tile.image, Math.floor(px), Math.floor(py), Math.ceil(side) + 1, Math.ceil(side) + 1);
                }
            }
        }
    }

    /* Paint everything: `layers` are functions of this map. */
    draw(layers) {
        const {canvas, context: c} = this, scale = globalThis.devicePixelRatio || 1;
        const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
        if (canvas.width !== width || canvas.height !== height) {
            Object.assign(canvas, {width, height});
        }
        c.setTransform(scale, 0, 0, scale, 0, 0);
        this.drawTiles();
        layers.forEach((layer) => layer(this));
        this.drawScale();
        if (this.isKeyboard && document.activeElement === canvas) {
            this.drawCrosshair();
        }
    }

    drawCrosshair() {
        const {context: c, canvas: {clientWidth, clientHeight}} = this, x = clientWidth / 2, y = clientHeight / 2;
        [['#000', 4], ['#6cf', 2]].forEach(([colour, wide]) => this.stroke(colour, wide, () => {
            [[-22, 0, -6, 0], [6, 0, 22, 0], [0, -22, 0, -6], [0, 6, 0, 22]].forEach(([a, b, d, e]) => {
                c.moveTo(x + a, y + b);
                c.lineTo(x + d, y + e);
            });
        }));
    }

    drawScale() {
        const {context: c, canvas: {clientHeight}} = this, metres = this.metresPerPixel();
        const nm = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((n) => n * NAUTICAL_MILE_M / metres > 60)
            ?? 1000;
        const long = nm * NAUTICAL_MILE_M / metres, y = clientHeight - 14;
        [['#000', 4], ['#fff', 2]].forEach(([colour, wide]) => this.stroke(colour, wide, () => {
            c.moveTo(12, y - 4);
            c.lineTo(12, y);
            c.lineTo(12 + long, y);
            c.lineTo(12 + long, y - 4);
        }));
        this.words(`${nm} NM`, 18 + long, y + 4);
    }

    stroke(colour, wide, path, dash = []) {
        const {context: c} = this;
        Object.assign(c, {strokeStyle: colour, lineWidth: wide});
        c.setLineDash(dash);
        c.beginPath();
        path(c);
        c.stroke();
        c.setLineDash([]);
    }

    /* Words with an edge, which every ground lets be read. */
    words(text, x, y, colour = '#fff') {
        const {context: c} = this;
        Object.assign(c, {font: '13px system-ui, sans-serif', lineJoin: 'round', strokeStyle: '#000', lineWidth: 3,
            fillStyle: colour});
        c.strokeText(text, x, y);
        c.fillText(text, x, y);
    }

    line(places, colour, wide, dash = []) {
        this.stroke(colour, wide, (c) => places.forEach((place, i) => {
            const [x, y] = this.toPixel(place);
            if (i === 0 || place.isBreak) {
                c.moveTo(x, y);
            } else {
                c.lineTo(x, y);
            }
        }), dash);
    }

    circle(place, radiusPx, colour, wide, fill = null, dash = []) {
        const {context: c} = this, [x, y] = this.toPixel(place);
        this.stroke(colour, wide, () => c.arc(x, y, radiusPx, 0, 2 * Math.PI), dash);
        if (fill) {
            c.fillStyle = fill;
            c.fill();
        }
    }

    /* A pixel that lies so many metres from a place in a direction. */
    offset(place, bearingDeg, distanceM) {
        return this.toPixel(ahead(place, bearingDeg, distanceM));
    }
}
