/* The tour: what the display can show, one thing after the other. Each stop says what to look at,
 * and sets the display by its own keys. */

const TOWN = [41.9949518, -29.0079712], AIRFIELD = [41.961458, -28.9784784];

/* Press keys of the bezel, one after the other. */
const press = (...keys) => async (page) => {
    for (const key of keys) {
        await page.tap(key);
    }
};

export const STOPS = [
    {title: 'Ground map',
        text: 'The aircraft flies in from the sea. Water is dark, the far shore and the town are bright, hills are bright '
            + 'in front and black behind. The sweep draws line by line, as an antenna turns.',
        act: async () => {}},
    {title: 'Range',
        text: 'Keys 19 and 20 step the range, which stands between them. At a shorter range the coast opens up.',
        act: press(19)},
    {title: 'Moving targets',
        text: 'Key 1 turns through the modes. GMT removes the ground and shows what moves: vehicles on the roads, '
            + 'a ferry on the bay.',
        act: press(1)},
    {title: 'Sea',
        text: 'SEA is for ships: the ground is weakened, and the sea returns little.',
        act: press(1)},
    {title: 'Doppler beam sharpening',
        text: 'Back in the ground map, key 3 turns through the fields of view. EXP is a closer window around the cursor; '
            + 'DBS1 and DBS2 sharpen it by Doppler, but not close to the track.',
        act: press(1, 1, 3, 3)},
    {title: 'A patch of the town',
        text: 'Designate draws a patch of synthetic aperture around the cursor, as a photograph in radar light. Streets '
            + 'flash where they are square to the radar; buildings lean towards it and throw shadows.',
        act: async (page) => page.patch(...TOWN, 2)},
    {title: 'A patch of the airfield',
        text: 'Runway and apron are smooth and dark. The row of bright points is parked aircraft, each drawn from a '
            + 'signature that was ray-traced for its aspect.',
        act: async (page) => page.patch(...AIRFIELD, 1)},
    {title: 'Your turn',
        text: 'Key 1 leads back to the map. Move the cursor with the arrows, designate with Enter, and fly with J and L. '
            + 'Key 5 opens the settings, key 12 what the display knows about itself.',
        act: press(1)},
];

export class Tour {
    constructor(page, show) {
        this.page = page;
        this.show = show;
        this.at = 0;
        this.isBusy = false;
        this.tell();
    }

    tell() {
        const {title, text} = STOPS[this.at];
        this.show(`${this.at + 1} of ${STOPS.length}. ${title}. ${text}`, this.at > 0, this.at + 1 < STOPS.length);
    }

    /* Go on to the next stop, or begin again behind the last one. */
    async next() {
        if (this.isBusy) {
            return;
        }
        this.isBusy = true;
        this.at = (this.at + 1) % STOPS.length;
        this.tell();
        await STOPS[this.at].act(this.page);
        this.isBusy = false;
    }

    /* Read the stop before once more; the display stays as it is. */
    back() {
        this.at = Math.max(this.at - 1, 0);
        this.tell();
    }
}
