"""The clamped plate's FRF with noise of 1 %, told in the column std: noise.py FRF.csv NOISY.csv"""

import random
import sys

PART = 0.01
random.seed(1)
with open(sys.argv[1]) as exact, open(sys.argv[2], "w") as noisy:
    exact.readline()
    noisy.write("frequency_hz,re,im,std\n")
    for line in exact:
        frequency, re, im = (float(cell) for cell in line.split(",")[:3])
        # The deviation is that of the complex value: each part has 1/sqrt(2) of it.
        std = PART * abs(complex(re, im))
        re += random.gauss(0.0, std / 2**0.5)
        im += random.gauss(0.0, std / 2**0.5)
        noisy.write(f"{frequency:g},{re:.5e},{im:.5e},{std:.3e}\n")
