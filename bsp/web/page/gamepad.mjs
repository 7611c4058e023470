/* The gamepad: left stick the cursor, right stick the flight, the first two buttons designate and
 * drop. A browser shows a gamepad once one of its buttons was pressed. */

const DEAD = 0.2; // of a stick's way
const state = {x: 0, y: 0, isTurning: false, isClimbing: false, buttons: []};

const outside = (deflection) => (Math.abs(deflection ?? 0) < DEAD ? 0 : deflection);

/* Look at the first gamepad, once a frame. */
export function gamepadActs(page) {
    const pad = navigator.getGamepads?.().find((p) => p);
    if (!pad) {
        return;
    }
    const x = Math.round(1000 * outside(pad.axes[0])), y = Math.round(-1000 * outside(pad.axes[1])) + 0;
    if (x !== state.x || y !== state.y) {
        page.unit.calls.slew(x, y);
        Object.assign(state, {x, y});
    }
    const [turn, climb] = [outside(pad.axes[2]), outside(pad.axes[3])];
    /* A stick that rests leaves the flight to others; one that has just come to rest levels it. */
    if (turn || state.isTurning) {
        page.bus.bankDeg = 60 * turn;
    }
    if (climb || state.isClimbing) {
        page.bus.climbMs = -40 * climb + 0;
    }
    Object.assign(state, {isTurning: turn !== 0, isClimbing: climb !== 0});
    const buttons = pad.buttons.map((b) => b.pressed);
    const isNew = (n) => buttons[n] && !state.buttons[n];
    if (isNew(0)) {
        page.unit.calls.designate();
    }
    if (isNew(1)) {
        page.unit.calls.drop();
    }
    state.buttons = buttons;
}
