# The kernel: every intersection, the grid, every way of walking it, shading, and equal bits of all copies.
grelha_test(sphere property grelha::kernel)
grelha_test(plane property grelha::kernel)
grelha_test(cone property grelha::kernel)
grelha_test(triangle property grelha::kernel)
grelha_test(grid property grelha::kernel)
grelha_test(walk property grelha::kernel)
