/* Weather of a day as a surface feels it: sun, sky, air and wind over local solar time. */
#ifndef INFRARED_WEATHER_H
#define INFRARED_WEATHER_H

struct ir_weather {
    double latitude;         /* radians, north positive */
    int day_of_year;         /* 1..366 */
    double air_kelvin;       /* mean of the day */
    double air_range_kelvin; /* between its coldest and its warmest hour, 15 h */
    double humidity;         /* relative, at the mean temperature, 0..1 */
    double wind_m_s;         /* 10 m above the ground */
    double cloud;            /* 0..1 of the sky */
};

/* What there is at one time. */
struct ir_air {
    double beam_w_m2;    /* sunlight straight from the sun, on a plane that faces it */
    double diffuse_w_m2; /* sunlight from the sky, on level ground */
    double sun[3];       /* unit vector towards the sun: east, north, up */
    double sky_w_m2;     /* thermal radiation of the sky */
    double sky_window; /* of the sky at 8..12 um, as a share of that of a body as warm as the air */
    double kelvin, vapour_hpa, wind_m_s;
    double density_kg_m3; /* 0: none, and no heat goes into it */
};

/* Declination of the sun, radians. */
double ir_declination(int day_of_year);

/* Unit vector towards the sun: east, north, up, which is below 0 at night. `hour` is local solar
 * time, 12 when the sun is highest. */
void ir_sun(const struct ir_weather *w, double hour, double sun[3]);

/* All of it at an hour, 0..24. */
struct ir_air ir_weather_at(const struct ir_weather *w, double hour);

/* Pressure of water vapour over water, hPa. */
double ir_saturation_hpa(double kelvin);

#endif
