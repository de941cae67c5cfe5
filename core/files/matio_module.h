// What is used of the library matio, by the module that is linked with it.
#pragma once

#include <matio.h>

namespace bentaxis::foreign {

struct MatioFunctions {
  decltype(&Mat_LogInit) log_init;
  decltype(&Mat_LogInitFunc) log_init_func;
  decltype(&Mat_Open) open;
  decltype(&Mat_Close) close;
  decltype(&Mat_VarReadNext) read_next;
  decltype(&Mat_VarFree) free;
  decltype(&Mat_VarGetNumberOfFields) number_of_fields;
  decltype(&Mat_VarGetStructFieldnames) field_names;
  decltype(&Mat_VarGetStructFieldByIndex) field;
};

}  // namespace bentaxis::foreign

extern "C" {
extern const bentaxis::foreign::MatioFunctions kBentaxisMatio;
}
