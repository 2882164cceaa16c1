#pragma once

typedef signed char int8_t;
typedef unsigned char uint8_t;
typedef int int32_t;
typedef unsigned uint32_t;
typedef long int64_t;
typedef unsigned long uint64_t;
#define INT64_MIN (-9223372036854775807L - 1)
#define PTRDIFF_MAX 9223372036854775807L
