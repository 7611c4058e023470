# The SocketCAN driver tried from inside a machine that has AF_CAN.
$(O)/bin/tests/panel-vm/can_driver: $(addprefix $(O)/,tests/panel-vm/can_driver.o drivers/can/can_socket.o drivers/can/can_log.o drivers/can/can_line.o) \
    $(LIB_firmware) $(LIB_fixed)
