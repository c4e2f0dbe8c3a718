#include "grelha.h"

const char* grelha_version(void) {
  return GRELHA_VERSION;
}
