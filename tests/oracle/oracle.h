// Moved.
#pragma once
#include "host/oracle/oracle.h"
