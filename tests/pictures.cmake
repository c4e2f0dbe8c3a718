grelha_test(spd_counts image grelha::frontend grelha::scenes)
