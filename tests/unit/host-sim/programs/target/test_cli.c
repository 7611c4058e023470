/* landmass-target as its user meets it. */
#include "check.h"
#include "support.h"

#include <stdio.h>
#include <string.h>

/* Run "landmass-target ARGUMENTS" in the scratch folder. */
static int run(const char *arguments)
{
    return support_run(
        "B=$(cd %s && pwd) && mkdir -p $B/tmp/target-cli && cd $B/tmp/target-cli && "
        "$B/bin/landmass-target %s",
        support_build_dir(), arguments);
}

static int shell(const char *command)
{
    return support_run("cd %s/tmp/target-cli && %s", support_build_dir(), command);
}

TEST(every_command_explains_itself)
{
    static const char *const commands[] = {"",      "model ",  "trace ",     "render ", "sheet ",
                                           "bake ", "curves ", "materials ", "bench "};
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        char line[64];
        snprintf(line, sizeof line, "%s--help >help", commands[i]);
        assert_int_equal(run(line), 0);
        assert_int_equal(shell("grep -q landmass-target help"), 0);
        assert_int_equal(shell("! grep -q landmass-db help"), 0);
    }
}

TEST(a_command_line_without_sense_ends_with_2)
{
    assert_int_equal(run("2>/dev/null"), 2);
    assert_int_equal(run("paint"), 2);
    assert_int_equal(run("trace --model slicy"), 2);
    assert_int_equal(run("trace --model slicy --out x --depression 0"), 2);
    assert_int_equal(run("render --model slicy --records x --out y.png"), 2);
    assert_int_equal(run("render --model slicy"), 2);
    assert_int_equal(run("render --model tank --law ohm --out y.png"), 2);
    assert_int_equal(run("bake --model tank --law ohm --out y.sig"), 2);
    assert_int_equal(run("render --records x.trace --azimuth 9 --out y.png"), 2);
    assert_int_equal(run("render --model slicy --complex y.tif"), 2);
    assert_int_equal(run("render --model slicy --weighting taylor --csv y.csv"), 2);
    assert_int_equal(run("render --model slicy --coherent --looks 2 --csv y.csv"), 2);
    assert_int_equal(run("render --model slicy --distance 50 --squint 9 --csv y.csv"), 2);
    assert_int_equal(run("sheet --model slicy --distance 50 --out y.png"), 2);
    assert_int_equal(run("render --model slicy --edges --csv y.csv"), 2);
    assert_int_equal(run("render --model slicy --edges --coherent --squint 9 --csv y.csv"), 2);
    assert_int_equal(run("render --model slicy --edges --coherent --distance 99 --csv y.csv"), 2);
}

/* Crossed power is below that of HH and VV, and of the same size either way; what would be ignored,
 * or is not known, is refused. */
TEST(a_polarisation_is_followed_with_laws_that_name_none)
{
    assert_int_equal(run("render --model slicy --polarisation hv --csv y.csv 2>/dev/null"), 2);
    assert_int_equal(
        run("render --model slicy --coherent --polarisation hv --distance 50 --csv y.csv "
            "2>/dev/null"),
        2);
    assert_int_equal(
        run("render --model slicy --coherent --polarisation hv --law spm-hh --csv y.csv "
            "2>/dev/null"),
        2);
    assert_int_equal(run("render --model slicy --coherent --law spm --csv y.csv 2>errors"), 1);
    assert_int_equal(shell("grep -q 'there is no law spm; give' errors && ! test -e y.csv"), 0);
    assert_int_equal(run("trace --model slicy --azimuth 20 --distance 50 --out near.trace "
                         ">/dev/null"),
                     0);
    assert_int_equal(run("render --records near.trace --coherent --polarisation hv --csv y.csv "
                         "2>errors"),
                     1);
    assert_int_equal(shell("grep -q 'are of one radar far away' errors && ! test -e y.csv"), 0);
    assert_int_equal(
        shell(
            "for p in hh hv vh vv; do ../../bin/landmass-target render --model tank --azimuth 40 "
            "--cells 160 --coherent --law fresnel --polarisation $p --csv $p.csv --complex $p.ntf "
            ">/dev/null || exit 1; gdalinfo $p.ntf | grep -qi \"LAW=fresnel $p\" || exit 1; "
            "awk -F, '{ for (i = 1; i <= NF; i++) s += $i * $i } END { print s }' $p.csv "
            ">$p.sum; done; "
            "awk -v hh=$(cat hh.sum) -v hv=$(cat hv.sum) -v vh=$(cat vh.sum) -v vv=$(cat vv.sum) "
            "'BEGIN { exit !(hv > 0 && hv < hh / 4 && vh < vv / 4 && hv < 4 * vh && vh < 4 * hv) "
            "}'"),
        0);
}

/* An upright plate from 65 degrees above: optics sends it away, its edges do not. Their layer is
 * the first.
 */
TEST(edges_make_a_turned_plate_brighter)
{
    static const char plate[] =
        "render --model plate --no-ground --depression 65 "
        "--cells 160 --coherent --law fresnel-hh --csv";
    char line[256];
    snprintf(line, sizeof line, "%s optics.csv", plate);
    assert_int_equal(run(line), 0);
    snprintf(line, sizeof line, "%s edges.csv --edges --layer 1", plate);
    assert_int_equal(run(line), 0);
    assert_int_equal(
        shell("paste -d, optics.csv edges.csv | awk -F, '{ n = NF / 2; for (i = 1; i <= n; i++) { "
              "if ($i > a) a = $i; if ($(i + n) > b) b = $(i + n) } } END { exit !(b > 2 * a) }'"),
        0);
    snprintf(line, sizeof line, "%s second.csv --edges --layer 2", plate);
    assert_int_equal(run(line), 0);
    assert_int_equal(shell("! grep -q '[1-9]' second.csv"), 0);
}

/* A near radar and a receiver apart go from trace to render by way of the file. */
TEST(near_and_bistatic_pictures_come_from_a_model_or_its_records)
{
    static const char ends[] = "--distance 40 --receiver-azimuth 70 --receiver-distance 30";
    char line[256];
    snprintf(line, sizeof line,
             "trace --model slicy --rays 1 --depression 40 %s --out ends.trace >log", ends);
    assert_int_equal(run(line), 0);
    snprintf(line, sizeof line, "render --model slicy --rays 1 --depression 40 %s --csv model.csv",
             ends);
    assert_int_equal(run(line), 0);
    assert_int_equal(run("render --records ends.trace --csv records.csv"), 0);
    assert_int_equal(shell("cmp model.csv records.csv"), 0);
    assert_int_equal(run("render --model slicy --rays 1 --depression 40 --csv far.csv"), 0);
    assert_int_equal(shell("! cmp -s model.csv far.csv"), 0);
    assert_int_equal(run("render --records ends.trace --squint 20 --csv x.csv 2>errors"), 1);
    assert_int_equal(shell("grep -q 'traced with --distance or a receiver apart' errors"), 0);
    assert_int_equal(run("render --records ends.trace --coherent --complex ends.tif"), 0);
    assert_int_equal(shell("gdalinfo ends.tif | grep -q 'ENDS=40; 70 40 30'"), 0);
    assert_int_equal(run("render --model slicy --distance 5 --csv x.csv 2>errors"), 1);
    assert_int_equal(shell("grep -q 'distance: it stands 1.29 m high' errors"), 0);
    assert_int_equal(run("render --model slicy --receiver-azimuth 180 --csv x.csv 2>errors"), 1);
    assert_int_equal(shell("grep -q 'receiver-azimuth: is 180 degrees from' errors"), 0);
}

/* A closed body of 7 m, moved and scaled: whatever the picture would not show is said. */
TEST(a_model_in_the_wrong_place_or_scale_is_doubted_with_its_sizes)
{
    static const struct {
        const char *command, *words;
    } doubts[] = {
        {"sed 's/Z/-0.5/' body > sunk.obj", "reaches 0.5 m below the ground.* of its 2 m"},
        {"sed 's/Z/0/;s/3.5/8/' body > long.obj", "reaches 8.06 m from its origin.*picture 5.4 m"},
        {"sed 's/Z/0/' body > millimetres.obj", "is 7e+03 m long, 2e+03 m wide and 2e+03 m high"},
        {"sed 's/Z/0/' body > sound.obj", ""},
    };
    static const char *const names[] = {"sunk", "long", "millimetres --scale 1000", "sound"};
    assert_int_equal(
        shell("printf 'v -3.5 -1 Z\nv 3.5 -1 Z\nv 3.5 1 Z\nv -3.5 1 Z\n' > body && sed "
              "'s/Z/T/' body > top && printf 'f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 "
              "8 7\nf 4 1 5 8\n' > faces"),
        0);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char line[512], file[32];
        snprintf(file, sizeof file, "%.*s.obj", (int)strcspn(names[i], " "), names[i]);
        snprintf(line, sizeof line, "%s && sed 's/T/%s/;s/3.5/%s/' top >> %s && cat faces >> %s",
                 doubts[i].command, i == 0 ? "1.5" : "2", i == 1 ? "8" : "3.5", file, file);
        assert_int_equal(shell(line), 0);
        snprintf(line, sizeof line, "render --up z --model %s%s --csv doubt.csv 2> doubts", file,
                 names[i] + strcspn(names[i], " "));
        assert_int_equal(run(line), 0);
        snprintf(line, sizeof line, "cat doubts; grep -q '%s' doubts", doubts[i].words);
        assert_int_equal(shell(doubts[i].words[0] ? line : "! grep . doubts"), 0);
    }
}

/* By small perturbation too the ground beside the tank is brighter than its shadow. */
TEST(rough_ground_has_a_shadow)
{
    assert_int_equal(run("render --model tank --cells 160 --law spm-vv --azimuth 90 --csv spm.csv"),
                     0);
    assert_int_equal(
        shell("awk -F, '{ if (NR < 6) for (i = 1; i <= NF; i++) { far += $i; n++ } "
              "r[NR] = 0; for (i = 36; i <= 44; i++) r[NR] += $i / 9 } "
              "END { least = 1e9; for (k = 8; k < 40; k++) if (r[k] < least) least = r[k]; "
              "print far / n, least; exit !(far / n > 1e-3 && least < 0.3 * far / n) }' spm.csv"),
        0);
    assert_int_equal(run("materials > materials.txt"), 0);
    assert_int_equal(shell("grep -q '^ground .* exponential 0 #' materials.txt"), 0);
    assert_int_equal(run("render --model tank --materials materials.txt --csv again.csv"), 0);
    assert_int_equal(shell("sed -i 's/exponential/fractal/' materials.txt"), 0);
    assert_int_equal(run("render --model tank --materials materials.txt --csv again.csv 2>errors"),
                     1);
    assert_int_equal(shell("grep -q 'materials.txt line 7: a spectrum is' errors"), 0);
}

/* Snow reflects less of what comes to it than wet soil: what stands on it has a weaker dihedral. */
TEST(ground_may_be_named)
{
    assert_int_equal(run("render --model dihedral --law fresnel-hh --rays 1 --ground wet-soil "
                         "--csv soil.csv"),
                     0);
    assert_int_equal(run("render --model dihedral --law fresnel-hh --rays 1 --ground snow "
                         "--csv snow.csv"),
                     0);
    assert_int_equal(
        shell("paste -d, soil.csv snow.csv | awk -F, '{ n = NF / 2; for (i = 1; i <= n; "
              "i++) { soil += $i * $i; snow += $(i + n) * $(i + n) } } "
              "END { exit !(soil > 1.4 * snow) }'"),
        0);
    assert_int_equal(run("render --model dihedral --ground cheese --csv x.csv 2>errors"), 1);
    assert_int_equal(shell("grep -q 'cheese: a material that no table has' errors"), 0);
    assert_int_equal(run("materials --bands >bands.txt"), 0);
    assert_int_equal(
        shell("grep -q '^wet-soil .*18.4-7.2i *-3.90 .* 8.2-5.5i *-5.42$' bands.txt && "
              "grep -q '^glass .*P.2040-3' bands.txt"),
        0);
    assert_int_equal(run("render --model dihedral --wavelength 0.003 --rays 1 --law fresnel-hh "
                         "--ground wet-snow --csv x.csv 2>errors"),
                     0);
    assert_int_equal(
        shell("grep -q 'wet-snow: warning: its permittivity holds from 3 to 37' errors"), 0);
}

TEST(a_resolution_that_the_cells_cannot_have_is_refused)
{
    assert_int_equal(run("render --model slicy --resolution 0.11 --csv fine.csv 2> errors"), 1);
    assert_int_equal(shell("grep -q 'cells of 0.1 m take 0.1184 to 12.67 m, not 0.11 m' errors"),
                     0);
    assert_int_equal(run("render --model slicy --resolution 0.12 --csv fine.csv"), 0);
}

/* Power is added, and spread by the same response: the pictures of the five reflections add up to
 * the whole one. */
TEST(layers_of_reflections_add_up_to_the_picture)
{
    assert_int_equal(run("trace --model slicy --azimuth 20 --out layers.trace"), 0);
    assert_int_equal(run("render --records layers.trace --csv layer0.csv"), 0);
    for (int layer = 1; layer <= 5; layer++) {
        char line[96];
        snprintf(line, sizeof line, "render --records layers.trace --layer %d --csv layer%d.csv",
                 layer, layer);
        assert_int_equal(run(line), 0);
    }
    assert_int_equal(
        shell("paste -d, layer0.csv layer1.csv layer2.csv layer3.csv layer4.csv layer5.csv | "
              "awk -F, '{ n = NF / 6; for (i = 1; i <= n; i++) { sum = 0; "
              "for (k = 1; k < 6; k++) { p = $(i + k * n) ^ 2; sum += p; of[k] += p } "
              "d = sum - $i ^ 2; if (d < 0) d = -d; if (d > 1e-4 * $i ^ 2 + 1e-12) bad++ } } "
              "END { exit !(!bad && of[1] > 0 && of[2] > 0 && of[3] > 0 && of[2] != of[1]) }'"),
        0);
    assert_int_equal(run("trace --model slicy --bounces 2 --out two.trace"), 0);
    assert_int_equal(run("render --records two.trace --layer 3 --csv no.csv 2>errors"), 1);
    assert_int_equal(
        shell("grep -q 'layer: reflection 3 was not traced' errors && ! test -e no.csv"), 0);
}

/* GDAL's own tools read the fields: their values are those of the CSV, row by row. */
TEST(complex_chips_are_read_by_other_programs)
{
    assert_int_equal(run("render --model slicy --azimuth 20 --coherent --law fresnel-vv "
                         "--complex chip.tif --csv chip.csv"),
                     0);
    assert_int_equal(run("render --model slicy --azimuth 20 --coherent --law fresnel-vv "
                         "--complex chip.ntf --csv again.csv"),
                     0);
    assert_int_equal(shell("cmp chip.csv again.csv && gdalinfo chip.tif >tif && gdalinfo chip.ntf "
                           ">ntf && grep -q Type=CFloat32 tif && grep -q WEIGHTING=taylor tif && "
                           "grep -q NITF_ICAT=SAR ntf && grep -q NITF_ISUBCAT=Q ntf && "
                           "grep -q 'WAVELENGTH_M=0.03123' ntf"),
                     0);
    assert_int_equal(
        shell("head -7 chip.csv | tail -1 | cut -d, -f31 >value && "
              "for f in chip.tif chip.ntf; do gdallocationinfo -valonly $f 30 6 | tr -d 'i' | "
              "sed -E 's/([0-9])[+]?([+-])/\\1 \\2/' | tr '\\n' ' ' | "
              "awk -v v=$(cat value) '{ d = sqrt($1 * $1 + $2 * $2) - v; "
              "exit !(d < 1e-4 * v && d > -1e-4 * v) }' || exit 1; done"),
        0);
    assert_int_equal(run("render --model slicy --coherent --complex chip.raw 2>errors"), 1);
    assert_int_equal(shell("grep -q 'chip.raw: has no known form; call it' errors"), 0);
    assert_int_equal(run("render --model slicy --coherent --pixel 4 --complex x.tif 2>errors"), 1);
    assert_int_equal(shell("grep -q 'pixels of 0.4 m hold' errors && ! test -e x.tif"), 0);
}

TEST(bad_input_ends_with_1_and_leaves_no_file)
{
    assert_int_equal(shell("rm -f out.png && printf 'v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n' "
                           ">open.obj"),
                     0);
    assert_int_equal(run("render --model open.obj --out out.png 2>errors"), 1);
    assert_int_equal(shell("grep -q '3 open edges.*--as-is' errors"), 0);
    assert_int_equal(run("render --model open.obj --as-is --up z --out out.png"), 0);
    assert_int_equal(shell("rm out.png"), 0);
    assert_int_equal(run("render --model nowhere.obj --out out.png"), 1);
    assert_int_equal(run("render --records open.obj --out out.png"), 1);
    assert_int_equal(run("render --model tank --pixel 5 --out out.png"), 1);
    assert_int_equal(run("bake --model tank --pixel 0.1 --out out.png"), 1);
    assert_int_equal(run("bake --model tank --depressions 20,10 --out out.png"), 1);
    assert_int_equal(run("bake --model tank --depressions 1,2,3,4,5,6,7,8,9 --out out.png"), 1);
    assert_int_equal(run("bake --model tank --name 'a name' --out out.png"), 1);
    assert_int_equal(shell("printf 'metal 1 2 3\\n' >bad.txt"), 0);
    assert_int_equal(run("render --model tank --materials bad.txt --out out.png"), 1);
    assert_int_equal(shell("! test -e out.png"), 0);
}

/* Is the largest difference of a.csv and c.csv below a thousandth of the brightest pixel? */
static int differ_little(void)
{
    return shell(
        "paste -d, a.csv c.csv | awk -F, '{ n = NF / 2; for (i = 1; i <= n; i++) { "
        "d = $i - $(i + n); d = d < 0 ? -d : d; worst = d > worst ? d : worst; "
        "most = $i > most ? $i : most } } END { exit !(most > 0 && worst < most / 1000) }'");
}

/* The same picture, whether the records took the way through a file or not. From the model that was
 * written as OBJ it is nearly the same: readers of models know single precision alone. */
TEST(records_render_as_their_model_does)
{
    assert_int_equal(run("render --model tank --azimuth 40 --law spm-vv --looks 4 --csv a.csv"), 0);
    assert_int_equal(run("trace --model tank --azimuth 40 --out tank.trace"), 0);
    assert_int_equal(run("render --records tank.trace --law spm-vv --looks 4 --csv b.csv"), 0);
    assert_int_equal(shell("cmp a.csv b.csv"), 0);
    assert_int_equal(shell("test $(wc -l <a.csv) = 54"), 0);
    assert_int_equal(run("model --model tank --obj tank.obj --view tank.png --size 64"), 0);
    assert_int_equal(run("trace --model tank.obj --up z --azimuth 40 --out again.trace"), 0);
    assert_int_equal(run("render --records again.trace --law spm-vv --looks 4 --csv c.csv"), 0);
    assert_int_equal(differ_little(), 0);
    assert_int_equal(run("materials >table.txt"), 0);
    assert_int_equal(run("render --model tank --azimuth 40 --law spm-vv --looks 4 "
                         "--materials table.txt --csv d.csv"),
                     0);
    assert_int_equal(shell("cmp a.csv d.csv"), 0);
}

/* The same file whatever the number of threads; its size is that of its chips. */
TEST(a_signature_is_baked_the_same_by_any_number_of_threads)
{
    assert_int_equal(run("bake --model slicy --aspects 3 --depressions 12,25 --rays 1 --threads 1 "
                         "--mean 5 --out a.sig --sheet sheet.png"),
                     0);
    assert_int_equal(run("bake --model slicy --aspects 3 --depressions 12,25 --rays 1 --threads 3 "
                         "--mean 5 --name a --out b.sig"),
                     0);
    assert_int_equal(shell("cmp a.sig b.sig && test $(wc -c <a.sig) = $((64+1152+6*4672)) && "
                           "head -c 4 sheet.png | tail -c 3 | grep -q PNG"),
                     0);
}

/* [Niu], Figure 26. Before the response the whole power is in the cells, as after it; in a picture
 * of four levels there are four greys, and cutting off 20 dB below the peak makes more of it white.
 */
TEST(the_picture_before_its_last_step_is_shown)
{
    assert_int_equal(
        run("render --model slicy --rays 1 --raw --csv raw.csv --out peak.png --zoom 1 "
            "--tone peak --levels 4"),
        0);
    assert_int_equal(run("render --model slicy --rays 1 --csv chip.csv"), 0);
    assert_int_equal(shell("test $(wc -l <raw.csv) = 108 && awk -F, '{ for (i = 1; i <= NF; i++) "
                           "s[FILENAME] += $i * $i } END { r = s[\"raw.csv\"] / s[\"chip.csv\"]; "
                           "print r; exit !(r > 0.9 * 4 && r < 1.1 * 4) }' raw.csv chip.csv"),
                     0);
    assert_int_equal(run("render --model slicy --rays 1 --raw --out cut.png --zoom 1 --tone cut "
                         "--levels 4"),
                     0);
    assert_int_equal(
        shell("gdalinfo -hist peak.png >peak.txt && gdalinfo -hist cut.png >cut.txt && "
              "whites() { grep -A1 'buckets from' $1 | sed -n 2p | awk '{ print $NF }'; "
              "}; greys() { grep -A1 'buckets from' $1 | sed -n 2p | tr ' ' '\\n' | "
              "grep -c '^[1-9]'; } && test $(greys peak.txt) = 4 && "
              "test $(whites cut.txt) -gt $(whites peak.txt)"),
        0);
    assert_int_equal(run("render --model slicy --raw --looks 2 --csv x.csv 2>errors"), 2);
    assert_int_equal(run("render --model slicy --out x.png --cut-db 3 2>errors"), 2);
}

/* A dihedral's seam stands in its origin: at the place that was given. Ground 5 m behind it, as the
 * radar in the north looks, is 5 m further south: by the lengths of a degree at 45 degrees, 111,132
 * and 78,847 m (NIMA TR8350.2). So is the heading: the same radar sees the nose turned east. */
TEST(a_chip_lies_at_its_place_on_earth)
{
    assert_int_equal(
        run("render --model dihedral --coherent --rays 1 --cells 108 --latitude 45 "
            "--longitude 10 --heading 90 --azimuth 270 --complex place.tif --csv c.csv"),
        0);
    /* 54 pixels of 0.2 m of slant range: row 27 is the middle; 25 pixels down are nearer, north. */
    assert_int_equal(
        shell("echo '27 27 0\n27 52 0\n52 27 0' | gdaltransform place.tif >at.txt && "
              "awk 'function near(a, b) { d = a - b; return d < 0.002 && d > -0.002 } "
              "{ e[NR] = ($1 - 10) * 78847; n[NR] = ($2 - 45) * 111132 } "
              "END { c = 5 / cos(15 * 3.14159265 / 180); print n[2], e[3]; "
              "exit !(near(e[1], 0) && near(n[1], 0) && near(e[2], 0) && near(n[2], c) && "
              "near(e[3], -5) && near(n[3], 0)) }' at.txt"),
        0);
    assert_int_equal(shell("gdalinfo place.tif | grep -q 'WGS 84'"), 0);
    assert_int_equal(run("render --model dihedral --latitude 45 --csv c.csv 2>errors"), 2);
    assert_int_equal(run("render --model dihedral --rays 1 --squint 30 --csv squint.csv"), 0);
    assert_int_equal(run("render --model dihedral --rays 1 --csv square.csv"), 0);
    assert_int_equal(shell("! cmp -s squint.csv square.csv"), 0);
}

/* GDAL reads the pixels: from near to far and from right to left, so the GeoTIFF's turned by half.
 * Its projections tell where the scene's centre is, of an odd number of pixels the target; the
 * radar is 10 km from it, north and below the depression. */
TEST(a_nitf_with_a_place_is_a_sicd)
{
    assert_int_equal(run("render --model dihedral --cells 162 --coherent --law fresnel "
                         "--polarisation hv --latitude 45 --longitude 10 --heading 90 "
                         "--azimuth 270 --complex sicd.ntf >/dev/null"),
                     0);
    assert_int_equal(run("render --model dihedral --cells 162 --coherent --law fresnel "
                         "--polarisation hv --latitude 45 --longitude 10 --heading 90 "
                         "--azimuth 270 --complex sicd.tif >/dev/null"),
                     0);
    assert_int_equal(
        shell(
            "gdalinfo -mdd xml:DES sicd.ntf >info && grep -q NITF_IMODE=P info && "
            "grep -q NITF_IREP=NODISPLY info && grep -q 'name=\"XML_DATA_CONTENT\"' info && "
            "for at in '30 6' '40 40' '11 70'; do set -- $at; "
            "gdallocationinfo -valonly sicd.ntf $((80 - $1)) $((80 - $2)) | tr '\\n' ' ' >of_ntf; "
            "gdallocationinfo -valonly sicd.tif $1 $2 | tr -d 'i' | "
            "sed -E 's/([0-9])[+]?([+-])/\\1 \\2/' >of_tif; "
            "paste -d' ' of_ntf of_tif | awk '{ exit !($1 == $3 && $2 == $4 && $1 != 0) }' || "
            "exit 1; done"),
        0);
    assert_int_equal(
        shell("grep -ao '<SICD .*</SICD>' sicd.ntf >text && "
              "grep -q '<TxRcvPolarizationProc>V:H<' text && "
              "vec() { sed -E \"s/.*<$1><X>([^<]*)<.X><Y>([^<]*)<.Y><Z>([^<]*)<.*/\\1 \\2 \\3/\" "
              "text; }; "
              "echo '10 45 0' | gdaltransform -s_srs EPSG:4979 -t_srs EPSG:4978 >earth && "
              "vec ECF | paste -d' ' - earth | awk '{ d = ($1 - $4)^2 + ($2 - $5)^2 + ($3 - $6)^2; "
              "exit !(d < 1e-4) }' && "
              "vec ARPPos | gdaltransform -s_srs EPSG:4978 -t_srs EPSG:4979 | "
              "awk '{ n = ($2 - 45) * 111132; e = ($1 - 10) * 78847; "
              "exit !(n > 9640 && n < 9680 && e < 1 && e > -1 && $3 > 2580 && $3 < 2605) }'"),
        0);
}

TEST(histograms_count_every_reflection)
{
    assert_int_equal(run("trace --model slicy --rays 1 --out s.trace --histograms h.png "
                         "--json h.json >h.txt"),
                     0);
    assert_int_equal(
        shell("head -c 4 h.png | tail -c 3 | grep -q PNG && python3 -c \"import json; "
              "r = json.load(open('h.json'))['report']; n = sum(r['reflections']); "
              "h = r['histograms']; assert len(h) == 6; "
              "[exit(1) for x in h if sum(x['counts']) + x['beyond'] != n]; "
              "i = h[0]; top = i['counts'].index(max(i['counts'])); "
              /* Level ground at 15 degrees of depression: 75 from its normal, 1.5 a bin. */
              "assert i['name'] == 'incidence_deg' and 49 <= top <= 50\""),
        0);
}

/* The strongest points of a dihedral by way of both plates, one body: triangle by triangle,
 * at the height of the seam. A plate without ground comes back once. */
TEST(a_map_names_parts_triangles_and_heights)
{
    assert_int_equal(run("map --model dihedral --no-ground --depression 45 --rays 1 --csv map.csv "
                         "--out parts.png --heights heights.png >map.txt"),
                     0);
    assert_int_equal(shell("awk -F, 'NR > 1 && $3 > best { best = $3; row = $5 \" \" $8; h = $6 } "
                           "END { print row, h; exit !(row ~ /^2 [12]:[1-4]>[12]:[1-4]$/ && "
                           "h > 0.019 && h < 0.021) }' map.csv"),
                     0);
    assert_int_equal(shell("for f in parts.png heights.png; do "
                           "head -c 4 $f | tail -c 3 | grep -q PNG || exit 1; done"),
                     0);
    assert_int_equal(shell("grep -q '^ground .* 0.00 %' map.txt && test $(wc -l <map.txt) = 4"), 0);
}

TEST(sheets_and_curves_are_pictures)
{
    assert_int_equal(run("sheet --model slicy --count 2 --rays 1 --out sheet.png"), 0);
    assert_int_equal(run("trace --model slicy --bounces 2 --out s.trace --picture table.png"), 0);
    assert_int_equal(run("trace --model slicy --bounces 2 --out s.trace --picture no.png "
                         "--picture-of 3"),
                     1);
    for (int figure = 3; figure <= 6; figure++) {
        char line[64];
        snprintf(line, sizeof line, "curves --figure %d --out curves%d.png", figure, figure);
        assert_int_equal(run(line), 0);
    }
    assert_int_equal(shell("for f in sheet.png table.png curves[3456].png; do "
                           "head -c 4 $f | tail -c 3 | grep -q PNG || exit 1; done"),
                     0);
}
