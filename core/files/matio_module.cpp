#include "matio_module.h"

extern "C" {
const bentaxis::foreign::MatioFunctions kBentaxisMatio = {Mat_LogInit,
                                                          Mat_LogInitFunc,
                                                          Mat_Open,
                                                          Mat_Close,
                                                          Mat_VarReadNext,
                                                          Mat_VarFree,
                                                          Mat_VarGetNumberOfFields,
                                                          Mat_VarGetStructFieldnames,
                                                          Mat_VarGetStructFieldByIndex};
}
