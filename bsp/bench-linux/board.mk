# bench-linux: an ordinary PC. Flash is a file, glass is a window or PNG files, the bus is a log or SocketCAN.
CC  := gcc
AR  := gcc-ar
RUN :=
