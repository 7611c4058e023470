/* The program as a user meets it. */
#include "check.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[] = "/tmp/landmass-netem-XXXXXX";

/* A training of seconds: a small picture, few rays. */
#define RECOVER                                                                                    \
    "%s/bin/landmass-netem recover --model slicy --cells 64 --rays 1 --number 6 --looks 2 "        \
    "--epochs 3 --pix-epochs 2 --out %s/%s"

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return support_run("rm -rf %s", folder);
}

TEST(every_command_explains_itself)
{
    static const char *const commands[] = {"",     "register", "train",   "score", "simulate",
                                           "bake", "plot",     "recover", "paper"};
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        assert_int_equal(support_run("%s/bin/landmass-netem %s --help | grep -q sage:",
                                     support_build_dir(), commands[i]),
                         0);
    }
}

TEST(a_command_line_that_makes_no_sense_is_told_so)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run("%s/bin/landmass-netem guess", b), 2);
    assert_int_equal(support_run("%s/bin/landmass-netem train --model tank", b), 2);
    assert_int_equal(
        support_run("%s/bin/landmass-netem recover --model slicy --out %s --rate x", b, folder), 2);
    assert_int_equal(support_run("%s/bin/landmass-netem recover --model slicy --out %s/none "
                                 "--architecture EP13",
                                 b, folder),
                     2);
}

/* The kernel lies in the training: options that would make another one are not taken. */
TEST(simulate_takes_no_option_that_it_would_ignore)
{
    static const char *const ignored[] = {"kernel-gain 2", "resolution 0.5", "wavelength 0.02"};
    for (size_t i = 0; i < sizeof ignored / sizeof ignored[0]; i++) {
        assert_int_equal(support_run("%s/bin/landmass-netem simulate --model slicy --training none "
                                     "--out %s/none --%s",
                                     support_build_dir(), folder, ignored[i]),
                         2);
    }
    assert_int_equal(support_run("%s/bin/landmass-netem score --model slicy --training none "
                                 "--chips none --out %s/none --kernel-gain 2",
                                 support_build_dir(), folder),
                     2);
}

TEST(a_training_killed_at_any_epoch_ends_in_the_same_file)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run(RECOVER, b, folder, "whole"), 0);
    assert_int_equal(support_run("cd %s/whole && ls loss.png specular.png back.png kernels.png "
                                 "table.png cw-ssim.png scores.tsv training.netem",
                                 folder),
                     0);
    assert_int_equal(support_run(RECOVER
                                 " & p=$!; while [ ! -s %s/cut/training.netem ] && "
                                 "kill -0 $p; do sleep 0.05; done; kill -9 $p; wait $p; true",
                                 b, folder, "cut", folder),
                     0);
    assert_int_equal(support_run(RECOVER, b, folder, "cut"), 1);
    assert_int_equal(support_run(RECOVER " --resume", b, folder, "cut"), 0);
    assert_int_equal(
        support_run("cmp %s/whole/training.netem %s/cut/training.netem", folder, folder), 0);
    assert_int_equal(support_run(RECOVER " --resume --batch 9", b, folder, "cut"), 1);
}

TEST(a_training_keeps_the_share_of_epochs_that_it_averages)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run(RECOVER " --average 0.5", b, folder, "averaged"), 0);
    assert_int_equal(support_run("grep -qx 'average 0x1p-1' %s/averaged/training.netem", folder),
                     0);
    assert_int_equal(support_run(RECOVER " --resume", b, folder, "averaged"), 1);
    assert_int_equal(support_run(RECOVER " --resume --average 0.5", b, folder, "averaged"), 0);
}

TEST(trainings_are_drawn_together)
{
    assert_int_equal(support_run("%s/bin/landmass-netem plot --training "
                                 "%s/whole/training.netem,%s/cut/training.netem --out %s/both",
                                 support_build_dir(), folder, folder, folder),
                     0);
    assert_int_equal(
        support_run("cd %s/both && ls loss.png specular.png back.png kernels.png", folder), 0);
}

/* What `simulate` writes is a chip: trained on itself it is scored as equal. */
TEST(learned_chips_can_be_made_and_read_again)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run("%s/bin/landmass-netem simulate --model slicy --cells 64 --rays 1 "
                                 "--training %s/whole/training.netem --views 3 --out %s/made",
                                 b, folder, folder),
                     0);
    assert_int_equal(
        support_run("cd %s/made && ls 000.00.png 120.00.png 240.00.csv && for a in 000 "
                    "120 240; do echo $a.00.csv $a 15 0 0 1 validation; done > list && "
                    "sed -i '1s/validation/training/' list",
                    folder),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem score --model slicy --cells 64 --rays 1 "
                                 "--training %s/whole/training.netem --chips %s/made/list --out "
                                 "%s/made/score",
                                 b, folder, folder, folder),
                     0);
    assert_int_equal(support_run("awk -F '\t' 'NR > 1 { n++; bad += $3 > 1e-9 } "
                                 "END { exit !(n == 2 && bad == 0) }' %s/made/score/scores.tsv",
                                 folder),
                     0);
}

/* The cells before the response, two to a pixel: the bright middle lies where it lies in the chip,
 * and cut 20 dB below the brightest each is ten times as bright, or white. */
TEST(the_cells_of_a_learned_chip_can_be_seen_before_the_response)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run("%s/bin/landmass-netem simulate --model slicy --cells 64 --rays 1 "
                                 "--training %s/whole/training.netem --azimuth 30 --raw "
                                 "--out %s/raw",
                                 b, folder, folder),
                     0);
    assert_int_equal(
        support_run("cd %s/raw && for k in peak cut; do "
                    "gdal_translate -q -of XYZ 030.00-$k.png $k.xyz; done && "
                    "paste -d' ' peak.xyz cut.xyz | awk '{ n++; want = 10 * $3; "
                    "white += $3 == 255; lit += $3 > 0; "
                    "bad += $6 < 255 && ($6 > want + 5.5 || $6 < want - 5.5); "
                    "bad += $6 == 255 && want < 249 } "
                    "END { exit !(n == 64 * 64 && white > 0 && lit > 20 && bad == 0) }'",
                    folder),
        0);
    assert_int_equal(
        support_run("cd %s/raw && tr , ' ' < 030.00.csv | awk 'FILENAME == \"-\" "
                    "{ for (i = 1; i <= NF; i++) { w = $i * $i; s += w; x += w * (i - 0.5); "
                    "y += w * (FNR - 0.5) } next } "
                    "{ w = $3 * $3; S += w; X += w * $1 / 2; Y += w * $2 / 2 } END { "
                    "dx = x / s - X / S; dy = y / s - Y / S; "
                    "exit !(s > 0 && dx * dx + dy * dy < 4) }' - peak.xyz",
                    folder),
        0);
}

/* The own law is given what `landmass-target render --csv` writes, so it fits that without error;
 * it once took power for amplitude. The null models are worse, the flat one by all of the variance.
 */
TEST(the_own_law_is_scored_by_the_amplitudes_that_render_writes)
{
    const char *b = support_build_dir();
    assert_int_equal(
        support_run("mkdir -p %s/law && cd %s/law && for a in 0 40 80 120 160; do $OLDPWD/%s/bin/"
                    "landmass-target render --model slicy --cells 64 --rays 2 --azimuth $a --csv "
                    "$a.csv || exit 1; echo $a.csv $a 15 0 0 10 training; done > list && "
                    "sed -i '4,5s/training/validation/' list",
                    folder, folder, b),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem score --model slicy --cells 64 --rays 2 "
                                 "--training %s/whole/training.netem --chips %s/law/list --out "
                                 "%s/law/score --json %s/law/json",
                                 b, folder, folder, folder, folder),
                     0);
    assert_int_equal(
        support_run("python3 -c 'import json, sys\n"
                    "s = json.load(open(sys.argv[1]))[\"report\"][\"score\"]\n"
                    "print(s)\n"
                    "assert s[\"own_law\"][\"mse\"] < 1e-6\n"
                    "for null in \"flat\", \"mean_chip\", \"nearest_chip\", \"smoothed_chips\":\n"
                    "    assert s[null][\"mse\"] > 1e-4\n"
                    "assert s[\"nearest_chip_deg\"] == 60' %s/law/json",
                    folder),
        0);
}

/* Chips of "another vehicle" that are the learned simulator's own fit without error, and the
 * law's chips are never first beside them. */
TEST(other_vehicles_are_scored_beside)
{
    assert_int_equal(support_run("%s/bin/landmass-netem score --model slicy --cells 64 --rays 1 "
                                 "--training %s/whole/training.netem --chips %s/law/list --others "
                                 "%s/made/list --out %s/beside --json %s/beside.json",
                                 support_build_dir(), folder, folder, folder, folder, folder),
                     0);
    assert_int_equal(
        support_run("python3 -c 'import json, sys\n"
                    "r = json.load(open(sys.argv[1]))[\"report\"]\n"
                    "print(r)\n"
                    "assert 0 <= r[\"null_first_by_cw_ssim\"] <= 3\n"
                    "assert len(r[\"others\"]) == 1 and r[\"others\"][0][\"mse\"] < 1e-9\n"
                    "assert r[\"others\"][0][\"chips\"] == 3' %s/beside.json",
                    folder),
        0);
}

/* The tank has rubber, which a training on SLICY knows nothing of, and metal and ground at other
 * numbers than the lorry's ground has. */
TEST(materials_go_by_their_names)
{
    static const char *const commands[] = {
        "simulate --cells 64 --rays 1 --out %s/named",
        "score --cells 64 --rays 1 --chips %s/made/list --out %s/named",
        "bake --rays 1 --aspects 3 --depressions 30 --out %s/named.sig"};
    const char *b = support_build_dir();
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        char rest[512];
        snprintf(rest, sizeof rest, commands[i], folder, folder);
        assert_int_equal(support_run("%s/bin/landmass-netem %s --model tank --training "
                                     "%s/whole/training.netem 2> %s/refused",
                                     b, rest, folder, folder),
                         1);
        assert_int_equal(support_run("cat %s/refused && grep -q 'rubber: a material of the model "
                                     "that the training does not know' %s/refused",
                                     folder, folder),
                         0);
    }
}

/* A body of ground and one of metal, in files that name them in either order. */
TEST(the_order_of_materials_in_a_model_changes_nothing)
{
    static const char *const names[] = {"metal ground", "ground metal"};
    const char *b = support_build_dir();
    for (int i = 0; i < 2; i++) {
        assert_int_equal(
            support_run("cd %s && : > %d.obj && n=0 && for m in %s; do y=1; [ $m = metal ] && "
                        "y=-1; printf \"usemtl $m\\nv 0 $y 0.1\\nv 0 $((y + 1)) 0.1\\nv 0 $y "
                        "1\\nv -1 $y 0.1\\nf $((n+1)) $((n+2)) $((n+3))\\nf $((n+1)) $((n+4)) "
                        "$((n+2))\\nf $((n+1)) $((n+3)) $((n+4))\\nf $((n+2)) $((n+4)) "
                        "$((n+3))\\n\" >> %d.obj; n=$((n+4)); done",
                        folder, i, names[i], i),
            0);
        assert_int_equal(support_run("%s/bin/landmass-netem simulate --up z --model %s/%d.obj "
                                     "--cells 64 --rays 1 --training %s/whole/training.netem "
                                     "--azimuth 30 --out %s/order%d",
                                     b, folder, i, folder, folder, i),
                         0);
    }
    assert_int_equal(support_run("cmp %s/order0/030.00.csv %s/order1/030.00.csv", folder, folder),
                     0);
}

TEST(what_was_learned_can_be_baked)
{
    assert_int_equal(support_run("%s/bin/landmass-netem bake --model slicy --rays 1 --aspects 3 "
                                 "--depressions 15,30 --training %s/whole/training.netem --out "
                                 "%s/learned.sig && test $(wc -c <%s/learned.sig) = "
                                 "$((64+1152+6*4672))",
                                 support_build_dir(), folder, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem bake --model slicy --depressions 1 "
                                 "--training %s/whole/training.netem --out %s/none.sig",
                                 support_build_dir(), folder, folder),
                     1);
    assert_int_equal(support_run("test ! -e %s/none.sig", folder), 0);
}

/* All that takes a training takes one whose networks hand intensities on, and resumes no other. */
TEST(networks_that_hand_intensities_on_go_all_the_way)
{
    const char *b = support_build_dir();
    assert_int_equal(support_run(RECOVER " --connection intensity", b, folder, "handed"), 0);
    assert_int_equal(support_run(RECOVER " --connection sideways", b, folder, "none"), 2);
    assert_int_equal(support_run(RECOVER " --resume", b, folder, "handed"), 1);
    assert_int_equal(support_run(RECOVER " --resume --connection intensity", b, folder, "handed"),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem simulate --model slicy --cells 64 --rays 1 "
                                 "--training %s/handed/training.netem --azimuth 30 --views 2 "
                                 "--out %s/handed-chips",
                                 b, folder, folder),
                     0);
    assert_int_equal(
        support_run("cd %s/handed-chips && for a in 030 210; do echo $a.00.csv $a 15 0 0 1 "
                    "validation; done > list && sed -i '1s/validation/training/' list",
                    folder),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem score --model slicy --cells 64 --rays 1 "
                                 "--chips %s/handed-chips/list --training "
                                 "%s/handed/training.netem --out %s/handed-scores | "
                                 "grep 'learned   mse 0.000000'",
                                 b, folder, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem bake --model slicy --rays 1 --aspects 3 "
                                 "--depressions 30 --training %s/handed/training.netem --out "
                                 "%s/handed.sig && ! cmp -s %s/handed.sig %s/learned.sig",
                                 b, folder, folder, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem plot --training "
                                 "%s/handed/training.netem --out %s/handed-plot",
                                 b, folder, folder),
                     0);
}

/* Ground of a training is as the built-in table has it, permittivity 6. The file's lies between it
 * and metal; a first line beyond both is refused, and so is any by a training of names. */
TEST(a_material_between_those_learned_can_be_simulated)
{
    static const char simulate[] =
        "%s/bin/landmass-netem simulate --model slicy --cells 64 --rays 1 --azimuth 30 --training "
        "%s/%s/training.netem --out %s/%s";
    const char *b = support_build_dir();
    char line[512];
    assert_int_equal(support_run(RECOVER " --architecture EP10", b, folder, "surfaces"), 0);
    assert_int_equal(support_run(RECOVER " --architecture EP10 --resume", b, folder, "surfaces"),
                     0);
    assert_int_equal(support_run("cd %s && echo 'ground 4 10 0.001 0.02 0.3 0.02 0.03 1' > mid && "
                                 "echo 'ground 7 10 0.001 0.02 0.3 0.02 0.03 1' > beyond",
                                 folder),
                     0);
    snprintf(line, sizeof line, simulate, b, folder, "surfaces", folder, "as-learned");
    assert_int_equal(support_run("%s", line), 0);
    snprintf(line, sizeof line, simulate, b, folder, "surfaces", folder, "as-given");
    assert_int_equal(support_run("%s --materials %s/mid", line, folder), 0);
    assert_int_equal(
        support_run("cmp -s %s/as-learned/030.00.csv %s/as-given/030.00.csv", folder, folder), 1);
    assert_int_equal(support_run("%s --materials %s/beyond 2> %s/refused", line, folder, folder),
                     1);
    assert_int_equal(support_run("grep 'ground: has a permittivity of 7' %s/refused", folder), 0);
    snprintf(line, sizeof line, simulate, b, folder, "whole", folder, "as-given");
    assert_int_equal(support_run("%s --materials %s/mid", line, folder), 1);
    snprintf(line, sizeof line,
             "%s/bin/landmass-netem bake --model slicy --rays 1 --aspects 3 --depressions 30 "
             "--training %s/surfaces/training.netem --out %s/surfaces.sig",
             b, folder, folder);
    assert_int_equal(support_run("%s", line), 0);
    assert_int_equal(support_run("%s --materials %s/beyond", line, folder), 1);
}

/* The chips of the real T-72: found, learned for a moment, and scored. */
TEST(real_chips_go_all_the_way)
{
    char chips[512];
    const char *b = support_build_dir();
    if (!support_data_path("mstar_t72_15deg", chips, sizeof chips)) {
        skip();
    }
    assert_int_equal(support_run("mkdir -p %s/chips && for n in 05 20 80 81 82 83; do ln -sf "
                                 "$(realpath %s)/1700$n.jpeg %s/chips; done",
                                 folder, chips, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem register --model tank --cells 120 --rays 1 "
                                 "--views 24 --chips %s/chips --out %s/list.tsv",
                                 b, folder, folder),
                     0);
    assert_int_equal(support_run("test $(grep -vc '^#' %s/list.tsv) = 6", folder), 0);
    assert_int_equal(
        support_run("%s/bin/landmass-netem register --model tank --cells 120 --rays 1 "
                    "--views 24 --chips %s/chips --turned --out %s/turned.tsv && paste "
                    "%s/list.tsv %s/turned.tsv | awk '!/^#/ && ($2 + 180) %% 360 != "
                    "$9 { exit 1 }'",
                    b, folder, folder, folder, folder),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem train --model tank --cells 120 --rays 1 "
                                 "--chips %s/list.tsv --share 0.5 --epochs 2 --pix-epochs 1 "
                                 "--out %s/t72",
                                 b, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem score --model tank --cells 120 --rays 1 "
                                 "--chips %s/list.tsv --share 0.5 --training "
                                 "%s/t72/training.netem --set training --out %s/scored",
                                 b, folder, folder, folder),
                     0);
    assert_int_equal(support_run("test $(wc -l < %s/scored/scores.tsv) = 4", folder), 0);
    assert_int_equal(support_run("%s/bin/landmass-netem register --model tank --cells 120 --rays 1 "
                                 "--views 24 --training %s/t72/training.netem --chips %s/chips "
                                 "--out %s/again.tsv",
                                 b, folder, folder, folder),
                     0);
    assert_int_equal(support_run("test $(grep -vc '^#' %s/again.tsv) = 6", folder), 0);
}

/* In zones, a training knows each zone's material, and says so to who forgets them. */
TEST(zones_are_learned_each_by_itself)
{
    const char *b = support_build_dir();
    assert_int_equal(
        support_run("%s/bin/landmass-netem recover --architecture EP9 --zones 2 --model slicy "
                    "--cells 64 --rays 1 --number 6 --epochs 2 --pix-epochs 1 --out %s/zones && "
                    "grep -q '^materials .*metal.211' %s/zones/training.netem",
                    b, folder, folder),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem simulate --zones 2 --model slicy --cells "
                                 "64 --rays 1 --training %s/zones/training.netem --azimuth 10 "
                                 "--out %s/zoned",
                                 b, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem simulate --model slicy --cells 64 --rays 1 "
                                 "--training %s/zones/training.netem --azimuth 10 --out %s/none",
                                 b, folder, folder),
                     1);
}

/* EP9 has inputs for 32 materials, and EP11 for all that zones make. */
TEST(more_zones_need_more_inputs)
{
    static const char recover[] =
        "%s/bin/landmass-netem recover --architecture %s --zones 7 --sides --model tank-bare "
        "--cells 64 --rays 1 --number 2 --epochs 1 --pix-epochs 0 --out %s/%s";
    const char *b = support_build_dir();
    assert_int_equal(support_run(recover, b, "EP9", folder, "few"), 1);
    assert_int_equal(support_run("test -e %s/few/training.netem", folder), 1);
    assert_int_equal(support_run(recover, b, "EP11", folder, "many"), 0);
    assert_int_equal(support_run("grep -q '^materials .*metal.711 .*metal.711r' %s/many/"
                                 "training.netem",
                                 folder),
                     0);
    /* The same names in a file of EP9: refused. */
    assert_int_equal(support_run("mkdir -p %s/lie && sed 's/^architecture EP11$/architecture EP9/' "
                                 "%s/many/training.netem > %s/lie/training.netem",
                                 folder, folder, folder),
                     0);
    assert_int_equal(support_run("%s/bin/landmass-netem plot --training %s/lie/training.netem "
                                 "--out %s/lie 2>&1 | grep -q 'more names than EP9 knows'",
                                 b, folder, folder),
                     0);
}

/* The simulated response lies on the real ones within a twentieth of the peak, and one look is one
 * look. */
TEST(the_response_is_that_of_a_real_radar)
{
    char history[512];
    if (!support_data_path("gotcha_xband/data_3dsar_pass1_az001_HH.mat", history, sizeof history)) {
        skip();
    }
    assert_int_equal(support_run("%s/bin/landmass-netem response --history %s > %s/response",
                                 support_build_dir(), history, folder),
                     0);
    assert_int_equal(support_run("awk '/range|cross/ { n++; worse += $4 > 0.05 } "
                                 "END { exit !(n >= 4 && worse == 0) }' %s/response",
                                 folder),
                     0);
    assert_int_equal(support_run("awk '/^simulated/ { ok = $3 > 0.99 && $3 < 1.01 } "
                                 "END { exit !ok }' %s/response",
                                 folder),
                     0);
}

/* Raw chips by the published description, with the models' own pictures for magnitudes would teach
 * nothing new; that they are taken, divided and trained on in one command is what is shown. */
TEST(the_papers_experiment_is_one_command)
{
    const char *b = support_build_dir();
    assert_int_equal(
        support_run("cd %s && for d in 15 30; do mkdir -p s$d; for i in 1 2 3 4 5; do "
                    "h=\"[PhoenixHeaderVer01.04]\\nPhoenixHeaderLength= 00200\\n"
                    "native_header_length= 0\\nNumberOfColumns= 60\\nNumberOfRows= 60\\n"
                    "TargetAz= $((i * 60)).5\\nDesiredDepression= $d\\n[EndofPhoenixHeader]\\n\"; "
                    "printf \"$h\" > s$d/HB0$i.0$d; truncate -s 200 s$d/HB0$i.0$d; "
                    "head -c 28800 /dev/zero | tr '\\0' '<' >> s$d/HB0$i.0$d; done; done",
                    folder),
        0);
    assert_int_equal(support_run("%s/bin/landmass-netem paper --slicy-15 %s/s15 --slicy-30 %s/s30 "
                                 "--rays 1 --pretrain 1 --epochs 1 --pix-epochs 1 --out %s/paper",
                                 b, folder, folder, folder),
                     0);
    assert_int_equal(support_run("cd %s/paper/slicy-EP8 && ls loss.png table.png scores.tsv && "
                                 "test $(wc -l < scores.tsv) = 6",
                                 folder),
                     0);
}

TEST_GROUP(make_folder, remove_folder);
