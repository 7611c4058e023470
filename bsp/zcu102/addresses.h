/* Addresses and interrupt lines of the XCZU9EG, and clocks of the ZCU102 board. Source: Zynq
 * UltraScale+ Device TRM UG1085, table 10-1 (addresses) and table 13-1 (interrupt lines). */
#ifndef ZCU102_ADDRESSES_H
#define ZCU102_ADDRESSES_H

#define UART0_BASE 0xFF000000u
#define UART1_BASE 0xFF010000u
#define CAN0_BASE  0xFF060000u
#define CAN1_BASE  0xFF070000u
#define QSPI_BASE  0xFF0F0000u
#define SWDT_BASE  0xFD4D0000u /* of the full-power domain */
#define DP_BASE    0xFD4A0000u
#define DPDMA_BASE 0xFD4C0000u
#define GICD_BASE  0xF9010000u
#define GICC_BASE  0xF9020000u

enum {
    UART0_LINE = 53,
    UART1_LINE = 54,
    CAN0_LINE = 55,
    CAN1_LINE = 56,
    DP_LINE = 151,

    UART_CLOCK_HZ = 100000000,
    CAN_CLOCK_HZ = 100000000,
    SWDT_CLOCK_HZ = 100000000
};

#endif
