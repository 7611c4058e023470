"""scikit-learn's MLPClassifier on the very split that `landmass-db train --split-out` wrote.

classifier_peer.py score PRIORS FILE...   train on the rows of part "train", judge by those of part "held-out";
                                          prints overall accuracy and kappa for each FILE. PRIORS is `exemplars`,
                                          the rows as they are, or `equal`: as many of each class, drawn again
                                          from the few and left out of the many. Inputs are standardised. The
                                          better of its two ways to stop counts, chosen by the mean over the FILEs:
                                          no early stopping (its default), or early stopping.
classifier_peer.py speed               pixels per second of processor time of a 3-18-6 network
"""
import csv
import sys
import time
import warnings

import numpy
from sklearn.exceptions import ConvergenceWarning
from sklearn.metrics import accuracy_score, cohen_kappa_score
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


def with_equal_priors(classes, seed):
    random = numpy.random.RandomState(seed)
    names = sorted(set(classes))
    each = len(classes) // len(names)
    return numpy.concatenate([random.permutation(numpy.resize(random.permutation(numpy.flatnonzero(classes == name)), each))
                              for name in names])


def score(priors, path, early_stopping):
    inputs, classes, held_out = read_split(path)
    train, wanted = inputs[~held_out], classes[~held_out]
    if priors == "equal":
        rows = with_equal_priors(wanted, 1)
        train, wanted = train[rows], wanted[rows]
    network = make_pipeline(StandardScaler(), MLPClassifier((100,), random_state=1, early_stopping=early_stopping))
    network.fit(train, wanted)
    truth, given = classes[held_out], network.predict(inputs[held_out])
    return accuracy_score(truth, given), cohen_kappa_score(truth, given)


def score_all(priors, paths):
    ways = [[score(priors, path, early) for path in paths] for early in (False, True)]
    for accuracy, kappa in max(ways, key=lambda way: sum(accuracy for accuracy, _ in way)):
        print("%.4f %.4f" % (accuracy, kappa), flush=True)


def speed():
    random = numpy.random.RandomState(1)
    some = random.rand(6000, 3)
    network = MLPClassifier((18,), max_iter=3).fit(some, numpy.arange(6000) % 6)
    image = random.rand(4_000_000, 3).astype(numpy.float32)
    cpu = time.process_time()
    network.predict(image)
    print("%.2f" % (len(image) / (time.process_time() - cpu) / 1e6))


warnings.simplefilter("ignore", ConvergenceWarning)
if sys.argv[1:2] == ["score"]:
    score_all(sys.argv[2], sys.argv[3:])
elif sys.argv[1:] == ["speed"]:
    speed()
else:
    sys.exit(__doc__)
