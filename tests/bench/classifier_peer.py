"""scikit-learn's MLPClassifier on the very split that `landmass-db train --split-out` wrote.

classifier_peer.py score FILE...   train on the rows of part "train", judge by those of part "held-out";
                                   prints overall accuracy, kappa and mean of the classes for each FILE
classifier_peer.py speed           pixels per second of a 3-18-6 network, and the processors it kept busy
"""
import csv
import sys
import time
import warnings

import numpy
from sklearn.exceptions import ConvergenceWarning
from sklearn.metrics import accuracy_score, balanced_accuracy_score, cohen_kappa_score
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler


def read_split(path):
    with open(path, newline="") as stream:
        rows = csv.reader(stream)
        heading = next(rows)
        first = heading.index("input1")
        of_class, of_part = heading.index("class"), heading.index("part")
        rows = list(rows)
    inputs = numpy.array([[float(v) for v in row[first:]] for row in rows])
    classes = numpy.array([row[of_class] for row in rows])
    held_out = numpy.array([row[of_part] == "held-out" for row in rows])
    return inputs, classes, held_out


def score(path):
    inputs, classes, held_out = read_split(path)
    network = make_pipeline(StandardScaler(), MLPClassifier((100,), random_state=1))
    network.fit(inputs[~held_out], classes[~held_out])
    truth, given = classes[held_out], network.predict(inputs[held_out])
    print("%.4f %.4f %.4f" % (accuracy_score(truth, given), cohen_kappa_score(truth, given),
                              balanced_accuracy_score(truth, given)), flush=True)


def speed():
    random = numpy.random.RandomState(1)
    some = random.rand(6000, 3)
    network = MLPClassifier((18,), max_iter=3).fit(some, numpy.arange(6000) % 6)
    image = random.rand(4_000_000, 3).astype(numpy.float32)
    wall, cpu = time.perf_counter(), time.process_time()
    network.predict(image)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    print("%.2f %.2f" % (len(image) / wall / 1e6, cpu / wall))


warnings.simplefilter("ignore", ConvergenceWarning)
if sys.argv[1:2] == ["score"]:
    for name in sys.argv[2:]:
        score(name)
elif sys.argv[1:] == ["speed"]:
    speed()
else:
    sys.exit(__doc__)
