#include "sicd.h"

#include "hs/error.h"
#include "lm/version.h"
#include "tracer/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double deg = 3.14159265358979323846 / 180;
static const double light_m_s = 299792458;
enum { WEIGHTS = 512 };

struct place {
    double latitude_deg, longitude_deg;
};

/* Earth-fixed axes. */
struct frame {
    struct vec scene, up, north, east;
    struct vec away, across, sight; /* of the radar, as trace_axes has them */
    struct vec radar, velocity;     /* in the middle of the aperture */
    double band_range, band_across; /* cycles a metre */
    double duration_s;
    int scene_row, scene_column;
};

/* ---- geometry ---- */

/* Pixel of the file: rows from near to far, columns from right to left. */
static struct place place_of(const struct sicd *s, double row, double column)
{
    const double *d = s->degrees, x = s->width - 0.5 - column, y = s->height - 0.5 - row;
    return (struct place){d[3] + x * d[4] + y * d[5], d[0] + x * d[1] + y * d[2]};
}

static void set_axes(struct frame *f, struct place p)
{
    const double e2 = (2 - 1 / 298.257223563) / 298.257223563, a_m = 6378137;
    const double lat = p.latitude_deg * deg, lon = p.longitude_deg * deg;
    const double n_m = a_m / sqrt(1 - e2 * sin(lat) * sin(lat));
    f->scene = (struct vec){n_m * cos(lat) * cos(lon), n_m * cos(lat) * sin(lon),
                            n_m * (1 - e2) * sin(lat)};
    f->up = (struct vec){cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat)};
    f->east = (struct vec){-sin(lon), cos(lon), 0};
    f->north = vec_cross(f->up, f->east);
}

static struct frame frame_of(const struct sicd *s)
{
    const struct trace_look *look = &s->records->look;
    const double heading = (s->site->heading_deg + look->azimuth_deg + 180) * deg;
    const double down = look->depression_deg * deg, resolution_m = s->setup->resolution_m;
    struct frame f = {.scene_row = s->height / 2, .scene_column = s->width / 2};
    set_axes(&f, place_of(s, f.scene_row, f.scene_column));
    f.away = vec_mad(vec_scale(f.north, cos(heading)), f.east, sin(heading));
    f.across = vec_mad(vec_scale(f.east, cos(heading)), f.north, -sin(heading));
    f.sight = vec_mad(vec_scale(f.away, cos(down)), f.up, -sin(down));
    f.radar = vec_mad(f.scene, f.sight, -SICD_RANGE_M);
    f.velocity = vec_scale(f.across, SICD_SPEED_M_S);
    f.band_range = f.band_across = focus_band(s->weighting, resolution_m);
    f.duration_s = f.band_across * look->wavelength_m / 2 * SICD_RANGE_M / SICD_SPEED_M_S;
    return f;
}

static double angle_deg(struct vec v, const struct frame *f)
{
    const double turn_deg = atan2(vec_dot(v, f->east), vec_dot(v, f->north)) / deg;
    return turn_deg < 0 ? turn_deg + 360 : turn_deg;
}

/* ---- words ---- */

static void put_vec(FILE *out, const char *name, struct vec v)
{
    fprintf(out, "<%s><X>%.15g</X><Y>%.15g</Y><Z>%.15g</Z></%s>", name, v.x, v.y, v.z, name);
}

static void put_corner(FILE *out, const char *index, struct place p)
{
    fprintf(out, "<ICP index=\"%s\"><Lat>%.12g</Lat><Lon>%.12g</Lon></ICP>", index, p.latitude_deg,
            p.longitude_deg);
}

static const char *letters_of(const struct sicd *s)
{
    static const char *const channels[REFLECT_CHANNELS] = {NULL, "H:H", "V:H", "H:V", "V:V"};
    if (s->setup->channel != REFLECT_AS_LAW) {
        return channels[s->setup->channel]; /* sent, then received */
    }
    const char *end = strrchr(s->setup->law, '-');
    return !end ? "UNKNOWN" : strcmp(end, "-vv") == 0 ? "V:V" : "H:H";
}

static void put_head(FILE *out, const struct sicd *s)
{
    fprintf(out,
            "<SICD xmlns=\"urn:SICD:1.2.1\"><CollectionInfo><CollectorName>simulated"
            "</CollectorName><CoreName>simulated-%s</CoreName>"
            "<CollectType>MONOSTATIC</CollectType><RadarMode><ModeType>SPOTLIGHT</ModeType>"
            "</RadarMode><Classification>UNCLASSIFIED</Classification></CollectionInfo>"
            "<ImageCreation><Application>landmass-target %s</Application></ImageCreation>",
            s->setup->law, LM_VERSION);
}

static void put_image(FILE *out, const struct sicd *s, const struct frame *f)
{
    fprintf(out,
            "<ImageData><PixelType>RE32F_IM32F</PixelType><NumRows>%d</NumRows><NumCols>%d"
            "</NumCols><FirstRow>0</FirstRow><FirstCol>0</FirstCol><FullImage><NumRows>%d"
            "</NumRows><NumCols>%d</NumCols></FullImage><SCPPixel><Row>%d</Row><Col>%d</Col>"
            "</SCPPixel></ImageData>",
            s->height, s->width, s->height, s->width, f->scene_row, f->scene_column);
}

static void put_earth(FILE *out, const struct sicd *s, const struct frame *f, double corners[4][2])
{
    static const char *const names[4] = {"1:FRFC", "2:FRLC", "3:LRLC", "4:LRFC"};
    const struct place middle = place_of(s, f->scene_row, f->scene_column);
    fputs("<GeoData><EarthModel>WGS_84</EarthModel><SCP>", out);
    put_vec(out, "ECF", f->scene);
    fprintf(out, "<LLH><Lat>%.12g</Lat><Lon>%.12g</Lon><HAE>0</HAE></LLH></SCP><ImageCorners>",
            middle.latitude_deg, middle.longitude_deg);
    for (int i = 0; i < 4; i++) {
        const struct place p =
            place_of(s, i < 2 ? 0 : s->height - 1, i == 0 || i == 3 ? 0 : s->width - 1);
        corners[i][0] = p.latitude_deg;
        corners[i][1] = p.longitude_deg;
        put_corner(out, names[i], p);
    }
    fputs("</ImageCorners></GeoData>", out);
}

static void put_weights(FILE *out, enum focus_weighting weighting)
{
    static const char *const names[FOCUS_WEIGHTINGS] = {
        "<WindowName>UNIFORM</WindowName>",
        "<WindowName>HAMMING</WindowName>",
        ("<WindowName>TAYLOR</WindowName><Parameter name=\"NBAR\">4</Parameter>"
         "<Parameter name=\"SLL\">-35</Parameter>"),
    };
    double weights[WEIGHTS];
    fprintf(out, "<WgtType>%s</WgtType>", names[weighting]);
    if (weighting != FOCUS_UNIFORM) {
        focus_window(weighting, weights, WEIGHTS);
        fprintf(out, "<WgtFunct size=\"%d\">", WEIGHTS);
        for (int i = 0; i < WEIGHTS; i++) {
            fprintf(out, "<Wgt index=\"%d\">%.9g</Wgt>", i + 1, weights[i]);
        }
        fputs("</WgtFunct>", out);
    }
}

static void put_side(FILE *out, const char *name, const struct sicd *s, struct vec way, double band,
                     double middle)
{
    fprintf(out, "<%s>", name);
    put_vec(out, "UVectECF", way);
    fprintf(out,
            "<SS>%.12g</SS><ImpRespWid>%.12g</ImpRespWid><Sgn>-1</Sgn><ImpRespBW>%.12g"
            "</ImpRespBW><KCtr>%.12g</KCtr><DeltaK1>%.12g</DeltaK1><DeltaK2>%.12g</DeltaK2>",
            (double)s->setup->ratio * s->records->grid.cell_m, s->setup->resolution_m, band, middle,
            -band / 2, band / 2);
    put_weights(out, s->weighting);
    fprintf(out, "</%s>", name);
}

static void put_grid(FILE *out, const struct sicd *s, const struct frame *f)
{
    fprintf(out,
            "<Grid><ImagePlane>SLANT</ImagePlane><Type>PLANE</Type><TimeCOAPoly order1=\"0\" "
            "order2=\"0\"><Coef exponent1=\"0\" exponent2=\"0\">%.12g</Coef></TimeCOAPoly>",
            f->duration_s / 2);
    put_side(out, "Row", s, f->sight, f->band_range, 2 / s->records->look.wavelength_m);
    put_side(out, "Col", s, vec_scale(f->across, -1), f->band_across, 0);
    fputs("</Grid>", out);
}

static void put_poly(FILE *out, const char *name, double constant, double slope)
{
    fprintf(out,
            "<%s order1=\"1\"><Coef exponent1=\"0\">%.15g</Coef><Coef exponent1=\"1\">%.15g</Coef>"
            "</%s>",
            name, constant, slope, name);
}

static void put_flight(FILE *out, const struct frame *f)
{
    const struct vec first = vec_mad(f->radar, f->velocity, -f->duration_s / 2);
    fprintf(out,
            "<Timeline><CollectStart>" SICD_START
            "</CollectStart><CollectDuration>%.12g"
            "</CollectDuration></Timeline><Position><ARPPoly>",
            f->duration_s);
    put_poly(out, "X", first.x, f->velocity.x);
    put_poly(out, "Y", first.y, f->velocity.y);
    put_poly(out, "Z", first.z, f->velocity.z);
    fputs("</ARPPoly></Position>", out);
}

static void put_radar(FILE *out, const struct sicd *s, const struct frame *f)
{
    const char *letters = letters_of(s);
    const bool is_known = letters[1] == ':';
    const double middle_hz = light_m_s / s->records->look.wavelength_m;
    const double half_hz = f->band_range * light_m_s / 4;
    fprintf(out,
            "<RadarCollection><TxFrequency><Min>%.12g</Min><Max>%.12g</Max></TxFrequency>"
            "<TxPolarization>%.*s</TxPolarization><RcvChannels size=\"1\"><ChanParameters "
            "index=\"1\"><TxRcvPolarization>%s</TxRcvPolarization></ChanParameters></RcvChannels>"
            "</RadarCollection><ImageFormation><RcvChanProc><NumChanProc>1</NumChanProc>"
            "<ChanIndex>1</ChanIndex></RcvChanProc><TxRcvPolarizationProc>%s"
            "</TxRcvPolarizationProc><TStartProc>0</TStartProc><TEndProc>%.12g</TEndProc>"
            "<TxFrequencyProc><MinProc>%.12g</MinProc><MaxProc>%.12g</MaxProc></TxFrequencyProc>"
            "<ImageFormAlgo>OTHER</ImageFormAlgo><STBeamComp>NO</STBeamComp><ImageBeamComp>NO"
            "</ImageBeamComp><AzAutofocus>NO</AzAutofocus><RgAutofocus>NO</RgAutofocus>"
            "</ImageFormation>",
            middle_hz - half_hz, middle_hz + half_hz, is_known ? 1 : 7, letters, letters, letters,
            f->duration_s, middle_hz - half_hz, middle_hz + half_hz);
}

/* The slant plane's normal is up: the target is on the left of a radar that flies to its right. */
static void put_angles(FILE *out, const struct sicd *s, const struct frame *f)
{
    const struct vec normal = vec_cross(f->across, f->sight);
    const double upright = vec_dot(normal, f->up), graze_deg = s->records->look.depression_deg;
    const double apart = vec_dot(f->scene, f->radar) / vec_length(f->scene) / vec_length(f->radar);
    fprintf(out, "<SCPCOA><SCPTime>%.12g</SCPTime>", f->duration_s / 2);
    put_vec(out, "ARPPos", f->radar);
    put_vec(out, "ARPVel", f->velocity);
    put_vec(out, "ARPAcc", (struct vec){0, 0, 0});
    fprintf(out,
            "<SideOfTrack>L</SideOfTrack><SlantRange>%.12g</SlantRange><GroundRange>%.12g"
            "</GroundRange><DopplerConeAng>90</DopplerConeAng><GrazeAng>%.12g</GrazeAng>"
            "<IncidenceAng>%.12g</IncidenceAng><TwistAng>0</TwistAng><SlopeAng>%.12g</SlopeAng>"
            "<AzimAng>%.12g</AzimAng><LayoverAng>%.12g</LayoverAng></SCPCOA>",
            SICD_RANGE_M, vec_length(f->scene) * acos(fmin(apart, 1)), graze_deg, 90 - graze_deg,
            acos(fmin(upright, 1)) / deg, angle_deg(vec_scale(f->away, -1), f),
            angle_deg(vec_mad(f->up, normal, -upright), f));
}

char *sicd_text(const struct sicd *s, double corners[4][2])
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    const struct frame f = frame_of(s);
    if (!out) {
        hs_error("SICD", NULL, "out of memory");
        return NULL;
    }
    put_head(out, s);
    put_image(out, s, &f);
    put_earth(out, s, &f, corners);
    put_grid(out, s, &f);
    put_flight(out, &f);
    put_radar(out, s, &f);
    put_angles(out, s, &f);
    fputs(
        "<Radiometric><RCSSFPoly order1=\"0\" order2=\"0\"><Coef exponent1=\"0\" "
        "exponent2=\"0\">1</Coef></RCSSFPoly></Radiometric></SICD>",
        out);
    if (fclose(out) != 0) {
        free(text);
        hs_error("SICD", NULL, "out of memory");
        return NULL;
    }
    return text;
}
