"""Instances in FMPy's low-level interface, step by step, the same for FMI 2.0 and 3.0."""

import ctypes

import fmpy
import numpy as np
import pytest
from fmpy import fmi2, fmi3

both_versions = pytest.mark.parametrize("fmi", ["2", "3"], ids=["fmi2", "fmi3"])


class Instance:
    """Access to an instance by the names of the variables, whatever the version."""

    # FMPy's classes for FMI 2.0 and 3.0
    classes: tuple

    def __init__(self, folder, resources=None):
        """`resources` is passed to the FMU as its resource path or URI, where FMPy would pass its own."""
        self.description = fmpy.read_model_description(str(folder))
        self.reference = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages = []
        self.is_fmi2 = self.description.fmiVersion == "2.0"
        self.fmu = self.classes[not self.is_fmi2](
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.interface().modelIdentifier,
            instanceName="test",
        )
        if resources is not None:
            self.replace_resources(resources)
        self.instantiate()

    def instantiate(self):
        if self.is_fmi2:
            self.instantiate_fmi2()
        else:
            self.fmu.instantiate(loggingOn=True, logMessage=self.log)

    def replace_resources(self, resources):
        name = "fmi2Instantiate" if self.is_fmi2 else "fmi3InstantiateCoSimulation"
        position = 3 if self.is_fmi2 else 2
        original = getattr(self.fmu, name)

        def instantiate(*arguments):
            return original(*arguments[:position], resources, *arguments[position + 1 :])

        setattr(self.fmu, name, instantiate)

    def instantiate_fmi2(self):
        # the FMU must not keep the structure, but FMPy's objects behind it have to live
        self.callbacks = fmi2.fmi2CallbackFunctions()
        self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(
            lambda environment, name, status, category, message: self.log(environment, status, category, message)
        )
        self.callbacks.allocateMemory = fmi2.defaultCallbacks.allocateMemory
        self.callbacks.freeMemory = fmi2.defaultCallbacks.freeMemory
        self.fmu.instantiate(loggingOn=True, callbacks=self.callbacks)

    def log(self, environment, status, category, message):
        self.messages.append((status, category.decode(), message.decode()))

    def enter_initialization(self, start_s=0.0, stop_s=None):
        if self.is_fmi2:
            self.fmu.setupExperiment(startTime=start_s, stopTime=stop_s)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=start_s, stopTime=stop_s)

    def initialise(self, **values):
        self.enter_initialization()
        if values:
            self.set(values)
        self.fmu.exitInitializationMode()

    def set_by_reference(self, references, values):
        (self.fmu.setReal if self.is_fmi2 else self.fmu.setFloat64)(references, values)

    def get_by_reference(self, references):
        return (self.fmu.getReal if self.is_fmi2 else self.fmu.getFloat64)(references)

    def set(self, values):
        self.set_by_reference([self.reference[name] for name in values], list(values.values()))

    def get(self, *names):
        return self.get_by_reference([self.reference[name] for name in names])

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


class Slave(Instance):
    """An instance for Co-Simulation."""

    classes = (fmi2.FMU2Slave, fmi3.FMU3Slave)

    def interface(self):
        return self.description.coSimulation

    def step(self, time, size):
        return self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)


class Model(Instance):
    """An instance for Model Exchange."""

    classes = (fmi2.FMU2Model, fmi3.FMU3Model)

    def interface(self):
        return self.description.modelExchange

    def states(self):
        """Names of the states, in the order of the model structure."""
        return [derivative.variable.derivative.name for derivative in self.description.derivatives]

    def enter_continuous_time(self):
        if self.is_fmi2:
            # FMI 2.0, 3.2.1: initialisation ends in Event Mode, which is left when nothing changes any more
            assert self.fmu.newDiscreteStates()[0] is False
        self.fmu.enterContinuousTimeMode()

    def set_states(self, values):
        self.fmu.setContinuousStates(pointer(values), len(values))

    def get_states(self):
        values = np.empty(len(self.states()))
        self.fmu.getContinuousStates(pointer(values), len(values))
        return values

    def get_rates(self):
        values = np.empty(len(self.states()))
        function = self.fmu.getDerivatives if self.is_fmi2 else self.fmu.getContinuousStateDerivatives
        function(pointer(values), len(values))
        return values


def pointer(array):
    """What ctypes hands to C for an array of doubles."""
    return np.ascontiguousarray(array, dtype=float).ctypes.data_as(ctypes.POINTER(ctypes.c_double))
