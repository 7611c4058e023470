"""The scenes that are measured, and pictures of them through the tap (tap.c): numbers before tone.

Images are made by the project's own programs, as a user makes them:

    builtin    the country of landmass-scene, by the commands of `make run`
    yard       a testing ground of known shapes on a plain: edges, a forest, towers, a grid town, a bright point, vehicles
    plain      an even plain of -15 dB, 300 km wide, without spread
    sea        the same of water
    hawaii     three tiles of DTED level 1; needs the real data
    orihuela   the classes of Sentinel-2's bands near Orihuela; needs the real data
"""
import os
import subprocess
import threading
from pathlib import Path

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
S2 = "sen1floods11_spain_s1_s2/Spain_7370579_S2Hand.tif"
S1 = "sen1floods11_spain_s1_s2/Spain_7370579_S1Hand.tif"
DTED = [f"dted1_hawaii/{name}_3arc_v2.dt1" for name in ("n19_w155", "n19_w156", "n20_w156")]
CELLS = 256
# Kinds of classes, as the firmware numbers them.
GROUND, WATER, STRUCTURE, TREES = range(4)


class Picture:
    """A picture of the tap: planes of numbers and the head's lines."""

    def __init__(self, folder, name):
        self.head = {}
        self.classes = []
        for line in (folder / f"{name}.head").read_text().splitlines():
            key, *values = line.split()
            if key == "class":
                self.classes.append((values[0], int(values[1])))
            else:
                self.head[key] = values
        if "shape" not in self.head:
            return
        shape = [int(v) for v in self.head["shape"]]
        raw = np.fromfile(folder / f"{name}.raw", dtype=np.int32).reshape([-1] + shape)
        # A patch has a few more lines than cells: rays from the antenna, side by side at the centre's range. What is
        # measured is the middle of them; `every_line` is for places.
        self.every_line = dict(zip(self.head["planes"], raw))
        spare = (shape[0] - CELLS) // 2 if "cell" in self.every_line else 0
        self.planes = {name: plane[spare: shape[0] - spare] for name, plane in self.every_line.items()}

    def number(self, key):
        return float(self.head[key][0])

    @property
    def level_db(self):
        """[line][cell], range grows with the cell."""
        return self.planes["level"] / 256.0

    @property
    def power(self):
        return 10 ** (self.level_db / 10)

    @property
    def grey(self):
        return self.planes["grey"]

    @property
    def class_index(self):
        return self.planes["cell"] >> 4 & 15

    @property
    def gamma_db(self):
        """Reflectivity as the database holds it."""
        return (self.planes["cell"] >> 8) / 2 - 80

    @property
    def kind(self):
        table = np.full(16, -1)
        table[: len(self.classes)] = [kind for _, kind in self.classes]
        return table[self.class_index]

    @property
    def height_m(self):
        return self.planes["height_dm"] / 10

    @property
    def elevation_m(self):
        return self.planes["elevation"] / 16384

    def is_class(self, name):
        return self.class_index == [n for n, _ in self.classes].index(name)

    def sweeps_db(self):
        """[sweep][line][bin] of a sector."""
        names = [n for n in self.head["planes"] if n.startswith("level")]
        return np.stack([self.planes[n] for n in names]) / 256.0

    def azimuth_deg(self):
        """Of the middle of each line of a sector, from north."""
        line = np.arange(int(self.head["shape"][0])) + 0.5
        return self.number("heading") + self.number("left") + line * self.number("width")

    def range_m(self):
        """Slant range of the middle of each bin of a sector."""
        return self.number("edge_m") + (np.arange(int(self.head["shape"][1])) + 0.5) * self.number("cell_m")


class Scenes:
    """Builds images when they are first asked for, and draws pictures of them."""

    def __init__(self, build, data):
        self.bin = Path(build) / "bin"
        self.work = Path(build) / "tmp" / "realism"
        self.data = Path(data) if data else None
        self.work.mkdir(parents=True, exist_ok=True)
        self.pictures = {}
        self.locks = {name: threading.Lock() for name in ("builtin", "yard", "plain", "sea", "hawaii", "orihuela")}
        self.drawing = threading.Lock()

    # ---- images ----

    def run(self, program, *words, **options):
        path = self.bin / program if not program.startswith("gdal") else program
        done = subprocess.run([path, *map(str, words)], capture_output=True, text=True, **options)
        if done.returncode != 0:
            raise RuntimeError(f"{program} {' '.join(map(str, words))}: {done.stderr[-2000:]}")
        return done.stdout

    def has(self, path):
        """True if this file of the shared data is on this machine."""
        return self.data is not None and (self.data / path).is_file()

    def image(self, name):
        """Path of the scene's image, made if the programs are newer than it."""
        path = self.work / name / "scene.lmdb"
        with self.locks[name]:
            programs = [self.bin / "landmass-db", self.bin / "landmass-scene", Path(CLASSES), Path(__file__)]
            if not path.exists() or path.stat().st_mtime < max(p.stat().st_mtime for p in programs):
                path.parent.mkdir(exist_ok=True)
                getattr(self, f"make_{name}")(path.parent)
        return path

    def make_builtin(self, to):
        """The classes are the scene's own: the rows judge what the radar makes of them, not how well they are found."""
        self.run("landmass-scene", "--out", to / "scene")
        self.reflect_and_build(to, to / "scene/truth.tif", "--heights", to / "scene/heights.tif", "--detail",
                               to / "scene/detail.txt", "--terrain", to / "scene/terrain.tif")

    def make_orihuela(self, to):
        here = "host-sim/programs/realradar"
        image = self.data / S2
        self.run("landmass-db", "train", "--image", image, "--exemplars", f"{here}/orihuela.tsv",
                 "--map", f"{here}/orihuela.map", "--classes", CLASSES, "--goal", "0.99", "--net", to / "scene.net")
        self.run("landmass-db", "segment", "--image", image, "--classes", CLASSES, "--net", to / "scene.net",
                 "--out", to / "classes.tif")
        flat = to / "terrain.tif"
        write_raster(flat, np.full((40, 40), 10, np.float32), (-0.90, 0.008, 38.26, -0.008), 4326)
        self.reflect_and_build(to, to / "classes.tif", "--terrain", flat, "--cell", "10")

    def make_hawaii(self, to):
        terrain = [word for name in DTED for word in ("--terrain", self.data / name)]
        self.run("landmass-db", "build", "--classes", "host-sim/gallery/terrain.classes", *terrain, "--land-class", "land",
                 "--water-class", "sea", "--out", to / "scene.lmdb")

    def make_plain(self, to, land="field"):
        table = to / "even.classes"
        table.write_text(even_classes())
        write_raster(to / "terrain.tif", np.full((600, 600), 10, np.float32), UTM_PLAIN, 32626)
        self.run("landmass-db", "build", "--classes", table, "--terrain", to / "terrain.tif", "--land-class", land,
                 "--water-class", "water", "--out", to / "scene.lmdb")

    def make_sea(self, to):
        self.make_plain(to, "water")

    def make_yard(self, to):
        table = to / "even.classes"
        table.write_text(even_classes())
        classes, heights, gamma = yard_planes()
        write_raster(to / "classes.tif", classes, UTM_YARD, 32626)
        write_raster(to / "heights.tif", heights, UTM_YARD, 32626)
        write_raster(to / "reflectivity.tif", gamma, UTM_YARD, 32626)
        write_raster(to / "terrain.tif", np.full((60, 60), 10, np.float32), UTM_AROUND, 32626)
        for model in ("tank", "lorry"):
            self.run("landmass-target", "bake", "--model", model, "--aspects", "24", "--depressions", "15,40", "--rays", "1",
                     "--out", to / f"{model}.sig")
        (to / "targets.txt").write_text(yard_targets())
        self.run("landmass-db", "build", "--classes", table, "--class-raster", to / "classes.tif",
                 "--reflectivity", to / "reflectivity.tif", "--heights", to / "heights.tif", "--targets", to / "targets.txt",
                 "--terrain", to / "terrain.tif", "--land-class", "field", "--water-class", "water",
                 "--cell", "4.77", "--out", to / "scene.lmdb")

    def reflect_and_build(self, to, classes, *words):
        self.run("landmass-db", "reflect", "--class-raster", classes, "--classes", CLASSES,
                 "--out", to / "reflectivity.tif")
        self.run("landmass-db", "build", "--classes", CLASSES, "--class-raster", classes,
                 "--reflectivity", to / "reflectivity.tif", *words, "--out", to / "scene.lmdb")

    # ---- pictures ----

    def draw(self, scene, kind, **keys):
        """A picture of the tap; drawn once and kept. Keys are those of tap.c."""
        words = " ".join(f"{key}={value}" for key, value in sorted(keys.items()))
        name = f"{scene}-{len(self.pictures)}"
        image = self.image(scene)
        with self.drawing:
            if (scene, kind, words) not in self.pictures:
                folder = self.work / "pictures"
                folder.mkdir(exist_ok=True)
                self.run("tests/realism/realism_tap", image, folder, input=f"{kind} {name} {words}\n")
                self.pictures[scene, kind, words] = Picture(folder, name)
                (folder / f"{name}.raw").unlink(missing_ok=True)
        return self.pictures[scene, kind, words]

    def patch(self, scene, place, cell_m, look=0, range_m=20000, height_m=3000, **keys):
        return self.draw(scene, "sar", lat=place[0], lon=place[1], cell_mm=round(cell_m * 1000), look=look,
                         range_m=range_m, height_m=height_m, **keys)

    def sector(self, scene, place, **keys):
        return self.draw(scene, "sector", lat=place[0], lon=place[1], **keys)

    def place(self, name):
        """A named place of the built-in scene."""
        self.image("builtin")
        lines = (self.work / "builtin/scene/scene.txt").read_text().splitlines()
        header = next(i for i, line in enumerate(lines) if line.startswith("# place"))
        for line in lines[header + 1:]:
            words = line.split()
            if words and words[0] == name:
                return float(words[1]), float(words[2])
        raise KeyError(name)


def moved(place, azimuth_deg, metres):
    """The place so far in a direction. Spherical: for where a picture is taken, not for what is measured in it."""
    radius, azimuth = 6371000.0, np.radians(azimuth_deg)
    latitude = place[0] + np.degrees(metres * np.cos(azimuth) / radius)
    longitude = place[1] + np.degrees(metres * np.sin(azimuth) / radius / np.cos(np.radians(place[0])))
    return round(float(latitude), 8), round(float(longitude), 8)


# ---- the yard ----

# Upper left corner and pixel of rasters: x, step, y, step. UTM zone 26 N; (500000, 4650000) is 42.0002 N 27 W.
YARD_M = 3200
UTM_YARD = (500000 - YARD_M / 2, 1, 4650000 + YARD_M / 2, -1)
UTM_AROUND = (470000, 1000, 4680000, -1000)
UTM_PLAIN = (350000, 500, 4800000, -500)
YARD_CLASSES = ["field", "asphalt", "structure", "forest", "water"]
FIELD_DB, ASPHALT_DB, FOREST_DB, TOWN_DB = -15.0, -30.0, -12.0, 0.0
TOWER_M, BLOCK_M, FOREST_M = 300.0, 30.0, 12.0
POINT_DB = 35.0
# Places in the yard: metres east and north of its middle.
EDGE_20, EDGE_45 = (-1200, 1200), (1200, 1200)
# Directions of the edges from east, degrees: 20 and 45 on the grid of the map, whose cells are 4.77 m by 3.54 m here.
EDGES = {EDGE_20: 26.1, EDGE_45: 53.4}
FOREST, GRID_TOWN, TOWER, BLOCK, POINT = (0, 0), (-1200, -1200), (1300, -1400), (1300, -300), (0, -1300)
TANKS, CAR_PARK = (0, 1300), (600, -300)
FOREST_HALF_M, TOWN_HALF_M = 150, 200


def even_classes():
    """The class table of yard and plain: levels without spread; asphalt and fields meet along straight lines."""
    rows = [("field", "ground", FIELD_DB, 0), ("asphalt", "ground", ASPHALT_DB, 0), ("structure", "structure", TOWN_DB, 8),
            ("forest", "trees", FOREST_DB, 12), ("water", "water", -40, 0)]
    return "".join(f"[{name}]\ncolour = 9 9 {i}\nkind = {kind}\ngamma_db = {gamma}\nspread_db = 0\n"
                   f"limits_db = {gamma - 9} {gamma + 9}\ntexture = gaussian\nheight_m = {height}\nlooks = 1\n"
                   f"borders = {'straight' if name == 'asphalt' else 'natural'}\n\n"
                   for i, (name, kind, gamma, height) in enumerate(rows))


def utm_degrees(place):
    """Latitude and longitude of a place of the yard."""
    utm, geographic = osr.SpatialReference(), osr.SpatialReference()
    utm.ImportFromEPSG(32626)
    geographic.ImportFromEPSG(4326)
    latitude, longitude, _ = osr.CoordinateTransformation(utm, geographic).TransformPoint(
        500000 + place[0], 4650000 + place[1])
    return round(latitude, 9), round(longitude, 9)


def yard_planes():
    """Class, height and reflectivity of the yard, a metre a pixel, north up."""
    side = YARD_M
    axis = np.arange(side) + 0.5 - side / 2
    east, north = np.meshgrid(axis, -axis)
    classes = np.zeros((side, side), np.uint8)
    heights = np.zeros((side, side), np.float32)

    def box(place, half_east, half_north):
        return (abs(east - place[0]) < half_east) & (abs(north - place[1]) < half_north)

    for place, turn in EDGES.items():
        angle = np.radians(turn)
        beyond = (east - place[0]) * np.sin(angle) - (north - place[1]) * np.cos(angle) > 0
        classes[box(place, 300, 300) & beyond] = 1

    def paint(where, index, height_m):
        classes[where], heights[where] = index, height_m

    paint(box(FOREST, FOREST_HALF_M, FOREST_HALF_M), 3, FOREST_M)
    paint(box(CAR_PARK, 40, 25), 1, 0)
    paint((abs(north - CAR_PARK[1] - 40) < 4) & (abs(east - CAR_PARK[0]) < 300), 1, 0)
    paint(box(TOWER, 15, 15), 2, TOWER_M)
    paint(box(BLOCK, 30, 30), 2, BLOCK_M)
    # Houses of 12 m x 24 m, 8 m high, square to north, in blocks 40 m apart.
    in_town = box(GRID_TOWN, TOWN_HALF_M, TOWN_HALF_M)
    houses = ((east - GRID_TOWN[0]) % 24 < 12) & ((north - GRID_TOWN[1]) % 40 < 24)
    paint(in_town & houses, 2, 8)
    gamma = np.array([FIELD_DB, ASPHALT_DB, TOWN_DB, FOREST_DB, -40], np.float32)[classes]
    # One cell of the map that answers far above the rest, on flat ground.
    point = box(POINT, 2.4, 2.4)
    classes[point], gamma[point] = 1, POINT_DB
    return classes, heights, gamma


def yard_targets():
    """Four tanks 26 m apart on the field, each turned another way, and three rows of lorries on the car park."""
    rows = ["library tank tank.sig", "library lorry lorry.sig"]
    for i, (east, north, heading) in enumerate(((-13, -13, 350), (13, -13, 50), (-13, 13, 200), (13, 13, 95))):
        rows.append((TANKS, east, north, heading, f"tank-{i}", "tank"))
    rows += [(CAR_PARK, 8 * column - 32, 17 * row - 17, 5 * (column % 3), f"lorry-{row}-{column}", "lorry")
             for row in range(3) for column in range(9) if (row * 9 + column) % 5 != 3]
    lines = []
    for row in rows:
        if isinstance(row, str):
            lines.append(row)
            continue
        place, east, north, heading, name, model = row
        latitude, longitude = utm_degrees((place[0] + east, place[1] + north))
        lines.append(f"target {name} {latitude} {longitude} ground {heading} signature {model}")
    return "\n".join(lines) + "\n"


def write_raster(path, values, corner, epsg):
    kinds = {np.dtype(np.uint8): gdal.GDT_Byte, np.dtype(np.float32): gdal.GDT_Float32}
    rows, columns = values.shape
    file = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, kinds[values.dtype],
                                                ["COMPRESS=DEFLATE", "ZLEVEL=1"])
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(epsg)
    file.SetProjection(reference.ExportToWkt())
    file.SetGeoTransform((corner[0], corner[1], 0, corner[2], 0, corner[3]))
    file.GetRasterBand(1).WriteArray(values)


def find_data():
    """The folder of the shared data, or None. LANDMASS_DATA overrides it, as for the other tests."""
    path = Path(os.environ.get("LANDMASS_DATA", "../shared/data"))
    return path if path.is_dir() else None
